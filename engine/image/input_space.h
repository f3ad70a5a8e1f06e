// SPDX-License-Identifier: MIT
// Colour spaces that pictures may be stored in without saying so: logarithms of cameras, ACEScct, HDR broadcast, plain
// powers.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "image/color_encoding.h"

namespace afterglow {

struct InputSpace {
  const char* name;             ///< "logc3"
  const char* doc;              ///< curve and primaries, in one line
  double (*to_linear)(double);  ///< stored value (0…1 of full codes) to light; 1 is a white that diffuses
  Chromaticities primaries;
  bool of_display = false;  ///< a curve of displays: eight bits show no steps
  /// What an HLG display shows: behind the curve goes hlg_to_display (hlg_rendering.h).
  bool hlg_display = false;
  bool linear() const;  ///< stored values are light
};

/// All of them, by name. docs/math.md §24 has curves and sources.
std::span<const InputSpace> input_spaces();
std::vector<std::string> input_space_names();
/// Errors (usage): unknown, with those that there are.
Result<const InputSpace*> find_input_space(const std::string& name);

/// The stored samples are of this space, whatever the file says: its curve and primaries take the place of those of
/// `encoding`.
void use_input_space(const InputSpace& space, ColorEncoding& encoding);

}  // namespace afterglow
