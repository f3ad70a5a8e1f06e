// SPDX-License-Identifier: MIT
// A look of pixel effects as a look-up table: the lattice goes through the look as a picture.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "apps/look.h"
#include "core/result.h"
#include "image/picture.h"

namespace afterglow {

enum class Shaper { none, log };  ///< inputs are sRGB codes, or ACEScct (AP1) of scene-linear light

/// Names of the entries that a table cannot stand for, since they look around, at the pixel's place or at other frames
/// or layers, each with why: "glow (reads around)".
std::vector<std::string> unbakeable(const Look& look);

struct Cube {
  int size = 0;
  Shaper shaper = Shaper::none;
  bool keeps_negative = false;              ///< the look sees colours outside of Rec.709, as `gamut = "keep"` has it
  bool of_view = false;                     ///< the look ends in a view, whose codes they are
  std::vector<std::array<float, 3>> codes;  ///< codes 0…1 of the display, sRGB where it is no view; red runs fastest
};

/// Runs scene-linear colours through the look, in place.
using Through = std::function<Result<void>(Picture& colours)>;

Result<Cube> bake_cube(int size, Shaper shaper, bool keeps_negative, const Through& through);

/// Differences between the table, read tetrahedrally, and the look itself, in 8-bit codes, over `count` colours of its
/// domain.
struct BakeError {
  double most = 0, mean = 0;
};
Result<BakeError> bake_error(const Cube& cube, int count, const Through& through);

/// ".cube", ".clf" or ".png", whichever its case. Errors (usage): it is another.
Result<std::string> cube_extension(const std::filesystem::path& file);
/// The file by its extension: .cube, .clf, .png (blue by blue beside each other, 16 bits). Errors: usage, io.
Result<void> write_cube(const Cube& cube, const std::string& title, const std::filesystem::path& file);

}  // namespace afterglow
