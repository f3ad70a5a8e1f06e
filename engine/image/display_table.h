// SPDX-License-Identifier: MIT
// What a display is sent for scene-linear light: a view of an OpenColorIO configuration, or a monitor's ICC profile,
// baked into a lattice that a shader reads.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "image/ocio.h"

namespace afterglow {

/// A lattice of colours over red, green and blue of linear Rec.709. Planes lie, along each axis, by the shaper
///   position = zero + cells · log2(1 + bend · |x|^(3/8)), for x < 0: zero − cells_below · …
/// Light 0 and 1 have a plane each, so that what is cut off there is cut off exactly. Beyond the first and the last
/// plane light counts as theirs. Between planes: tetrahedral.
struct DisplayTable {
  std::string name;  ///< for people: "sRGB - Display, ACES 1 - SDR Video"
  int planes = 0;    ///< along each axis
  int zero = 0;      ///< the plane of light 0
  float bend = 1;
  float cells = 1, cells_below = 1;  ///< planes for each doubling of 1 + bend · |x|^(3/8)
  /// Codes of the display, 0…1, before they are held to that. Colour (r, g, b) is at
  /// (r + planes · (b mod kDisplayTiles), g + planes · ⌊b / kDisplayTiles⌋).
  Size size;
  std::vector<float> codes;  ///< RGBA
  /// How far the table is from what it was made of, in codes of 8 bits, in 4096 colours (docs/player.md says which).
  double largest_error = 0, mean_error = 0;
};

/// What pictures are shown on, and what could be chosen in its place.
struct ShownDisplay {
  DisplayTable table;
  std::string display, view;                 ///< of an OpenColorIO configuration; empty: a profile
  std::vector<OcioSurvey::Display> choices;  ///< of that configuration
  std::vector<std::filesystem::path> files;  ///< that it was made of
};

inline constexpr int kDisplayTiles = 8;  ///< slices beside each other

/// The view of the request. Its light is scene-linear, up to 64. Errors: script (the configuration, with its file and
/// line where one is known; a name of the request, with those it has and the nearest), io (OpenColorIO is missing).
/// `files` are the configuration and the tables of the view.
Result<ShownDisplay> display_of_config(const OcioRequest& request);

/// A monitor's profile: relative colorimetric, black point compensated. Its light is that of a display, 0…1 and what
/// larger gamuts need around it. Errors: io, with the file (missing, damaged, not of an RGB display).
Result<DisplayTable> icc_display_table(const std::filesystem::path& file);

/// Codes 0…1 for a light, as shaders read them; in double precision.
std::array<double, 3> read_display_table(const DisplayTable& table, const std::array<double, 3>& light);

}  // namespace afterglow
