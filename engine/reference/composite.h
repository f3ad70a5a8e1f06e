// SPDX-License-Identifier: MIT
// An entry's result over what it was given: opacity, blend modes and masks (math.md §20).
#pragma once

#include <map>
#include <memory>
#include <string>

#include "reference/stack.h"

namespace afterglow::reference {

/// Straight colours. `mode` is a name of math.md §20; std::out_of_range for others.
Rgb blend(const Rgb& below, const Rgb& above, const std::string& mode);

/// Is every mask that stands in it known here?
bool is_known(const Mask& mask);

/// How much each pixel counts, 0…1. `source`: what the entry was given.
std::vector<double> mask_of(const DoubleImage& source, const Inputs& inputs, const Mask& mask);

/// `above` over `below` by opacity and mask (null: everywhere); alpha is that of `below`.
DoubleImage composite(const DoubleImage& below, const DoubleImage& above, double opacity, const std::string& mode,
                      const std::vector<double>* mask);

}  // namespace afterglow::reference
