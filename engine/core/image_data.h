// SPDX-License-Identifier: MIT
// Pixels that a program brings along: look-up tables and pictures that an effect reads from files.
#pragma once

#include <filesystem>
#include <vector>

#include "core/geometry.h"
#include "core/hash.h"

namespace afterglow {

/// Immutable once made, and shared between graphs and programs.
struct ImageData {
  Size size;
  std::vector<float> pixels;   ///< RGBA, row by row
  Hash hash;                   ///< of size and pixels: equal hashes mean equal images
  std::filesystem::path file;  ///< where it came from
  bool opaque = false;         ///< a picture without alpha: its A is 1
};

}  // namespace afterglow
