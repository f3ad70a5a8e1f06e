// SPDX-License-Identifier: MIT
// All that one error says, line by line, each with the place in a file that it is about.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace afterglow {

/// A file that is wrong, and its line; 0: none is known.
struct ErrorPlace {
  std::filesystem::path file;
  int line = 0;
};

struct ErrorLine {
  std::string where;  ///< "FILE:LINE", or empty
  std::string what;   ///< the rest; of a line that only leads to a place ("included at FILE:LINE") all of it
  ErrorPlace place;   ///< without a file: the line names none
};

/// The lines of `Error::trail` behind the first: a shader's further errors, who includes or calls what is wrong.
std::vector<ErrorLine> further_lines(const Error& error);

/// The places of an error and its further lines, each once, in their order: what F4 steps through.
std::vector<ErrorPlace> error_places(const Error& error);

}  // namespace afterglow
