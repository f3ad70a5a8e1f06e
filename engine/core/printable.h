// SPDX-License-Identifier: MIT
// Text that may stand on a terminal. Names and contents of files that messages quote may hold escape sequences.
#pragma once

#include <string>

namespace afterglow {

/// Every control character (C0, DEL, C1 as UTF-8 spells it, and those that turn the direction of text or end lines)
/// becomes a space; line feeds stay when `lines` says so.
std::string printable(std::string text, bool lines = false);

}  // namespace afterglow
