// SPDX-License-Identifier: MIT
// Colour spaces of cameras and broadcast in double precision, after the papers of their makers (math.md §24): curves of
// one channel, and the way from and to linear Rec.709.
#pragma once

#include <string>
#include <vector>

#include "reference/double_image.h"

namespace afterglow::reference {

/// Names of all input spaces: "acescct", "acescg", …
const std::vector<std::string>& transfer_names();
/// Those that look-up tables are made for: all but linear light of other primaries.
const std::vector<std::string>& table_spaces();

/// Stored value to light, 1 a white that diffuses. `name` is one of the above.
double transfer_to_light(const std::string& name, double stored);
double light_to_transfer(const std::string& name, double light);

/// The same of colours, with the primaries: light is linear Rec.709.
Rgb transfer_to_rec709(const std::string& name, const Rgb& stored);
Rgb rec709_to_transfer(const std::string& name, const Rgb& light);

}  // namespace afterglow::reference
