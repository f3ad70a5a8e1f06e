// SPDX-License-Identifier: MIT
// Text that may stand on a terminal. Names and contents of files that messages quote may hold escape sequences.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace afterglow {

/// Every control character (C0, DEL, C1 as UTF-8 spells it, and those that turn the direction of text or end lines)
/// becomes a space; line feeds stay when `lines` says so.
std::string printable(std::string text, bool lines = false);

/// At most so many bytes from its beginning, with no part of a UTF-8 character at the end.
std::string_view cut_utf8(std::string_view text, std::size_t bytes);

/// One line of bounded length that a terminal can show: control characters replaced, long text cut (UTF-8 safe) with
/// "…".
std::string tidy_message(std::string text, std::size_t limit = 400);

}  // namespace afterglow
