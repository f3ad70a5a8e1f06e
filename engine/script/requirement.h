// SPDX-License-Identifier: MIT
// `requires = "0.2"` of a stack: the oldest Afterglow that runs it. Pure text.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace afterglow::script {

/// Major, minor, patch.
using Version = std::array<int, 3>;

/// "0.2" or "0.2.1"; nothing else.
std::optional<Version> parse_version(std::string_view text);

/// A newer Afterglow that the text of a preset asks for.
struct Requirement {
  std::string version;
  int line = 0;
};
/// Looks for `requires = "…"` in the text, before it is run: what an older program lacks may be anywhere in it.
/// Comments do not count.
std::optional<Requirement> newer_requirement(std::string_view text, const Version& own);

}  // namespace afterglow::script
