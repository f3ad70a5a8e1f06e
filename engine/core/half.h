// SPDX-License-Identifier: MIT
// Half floats on the CPU (IEEE 754 binary16), rounded to nearest even as GPUs do.
#pragma once

#include <cstddef>
#include <cstdint>

namespace afterglow {

inline constexpr float kMaxHalf = 65504;
inline constexpr std::uint16_t kMaxHalfBits = 0x7bff;

/// Values beyond ±65504, infinities too, become ±65504; NaN stays NaN. Returns how many values were held.
std::uint64_t halves_from_floats(const float* from, std::size_t count, std::uint16_t* to);

/// Of half floats, which need not be aligned. Returns how many values are ±65504, that is, were held there or beyond.
std::uint64_t floats_from_halves(const void* halves, std::size_t count, float* to);

/// The portable forms that both use where the CPU has no instruction for it; for tests.
std::uint16_t half_from_float(float value);
float float_from_half(std::uint16_t bits);

}  // namespace afterglow
