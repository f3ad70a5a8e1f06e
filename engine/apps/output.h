// SPDX-License-Identifier: MIT
// Standard output: what a command tells. Whether it arrived is looked at once, at the end, so that output which nobody
// reads stops no work.
#pragma once

#include <fmt/format.h>

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "core/result.h"

namespace afterglow {

/// Where one of these files is "-", standard output is for it alone: what people read goes to standard error from here
/// on.
void keep_standard_output_for(std::initializer_list<std::string_view> files);

void output_text(const std::string& text);

template <typename... Arguments>
void output(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  output_text(fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// The content of a file that a command was asked for; "-": standard output. Errors: io.
Result<void> output_file(const std::string& file, const std::string& text);

/// Writes what is still on its way. Errors (io): something could not be written. A reader that has gone
/// (`afterglow effects | head -1`) is no error.
Result<void> finish_output();

}  // namespace afterglow
