// SPDX-License-Identifier: MIT
// What Lua's parser says of characters that it does not know, said for people.
#pragma once

#include <string_view>

#include "core/result.h"

namespace afterglow::script {

/// A line of a text, 1-based, without its end; empty: there is none.
std::string_view line_of(std::string_view text, int line);

/// Says what may be wrong where the parser stopped: a comma, or a sign of equality. Moves the error to the line where
/// the comma is missing.
void name_missing(Error& error, std::string_view text);

/// Names the character in place of its first byte ("unexpected symbol near '<\226>'"), and what to write for it: quotes
/// and dashes that word processors and web pages make. `text`: of the script; the error knows its line.
void name_symbol(Error& error, std::string_view text);

}  // namespace afterglow::script
