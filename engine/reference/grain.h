// SPDX-License-Identifier: MIT
// Film grain and the random numbers it is made of: exact integers, so device and oracle agree to the bit.
#pragma once

#include <array>
#include <cstdint>

#include "reference/double_image.h"

namespace afterglow::reference {

/// pcg3d (Jarzynski, Olano, JCGT 9/3, 2020).
using Words = std::array<std::uint32_t, 3>;
/// 0 … 1, without 1: the upper 24 bits of a random word.
inline double unit(std::uint32_t word) { return (word >> 8u) / 16777216.0; }
Words pcg3d(Words v);

struct FilmGrain {
  double intensity = 0.3, response = 0.8, size = 1, colored = 0;
  std::uint32_t seed = 0, frame = 1;
};
DoubleImage film_grain(const DoubleImage& source, const FilmGrain& settings);

}  // namespace afterglow::reference
