// SPDX-License-Identifier: MIT
// The prelude's reading functions for images that are bound as storage images. GLSL cannot pass a storage image of one
// format to a function for any format, so each such image gets functions of its own, and an author's `fetch(depth, p)`
// becomes `ag_r2_fetch(p)`. Internal to the room.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "shader/token.h"

namespace afterglow {

/// The prelude's functions whose first argument is an image.
bool is_reading_function(std::string_view name);

/// True when every use of the input `name`, outside its declaration, is as the first argument of a reading function.
bool read_by_prelude_alone(const std::vector<Token>& tokens, std::string_view name);

/// The reading functions for the storage image `variable`, each with `prefix` before its name and without the image
/// argument.
std::string storage_reads(const std::string& prefix, const std::string& variable);

/// Input name → prefix of its functions.
using StorageReaders = std::map<std::string, std::string, std::less<>>;

}  // namespace afterglow
