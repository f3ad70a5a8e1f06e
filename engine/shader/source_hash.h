// SPDX-License-Identifier: MIT
// What this room is like: kernels that are kept on disk were made by all of it.
#pragma once

namespace afterglow {

/// Of the names and texts of all .cpp and .h files in this folder (cmake/source_hash.cmake).
extern const char* const kShaderSourceHash;

}  // namespace afterglow
