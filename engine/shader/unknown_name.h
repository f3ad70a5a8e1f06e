// SPDX-License-Identifier: MIT
// A compiler says that a name is unknown; authors want to know which one they meant, and where it is.
#pragma once

#include "core/paths.h"
#include "core/result.h"

namespace afterglow {

/// The compiler's error of an unknown function or variable, with the library below shaders/lib/ that has it, or with
/// the nearest of the names that its file knows. Other errors come back as they are. Reads files of the search path.
Error with_known_names(Error error, const SearchPath& path);

}  // namespace afterglow
