// SPDX-License-Identifier: MIT
// Colours that stay the half floats that a file holds.
#pragma once

#include <atomic>
#include <cstdint>

#include "image/color_encoding.h"

namespace afterglow {

/// Whether stored values of this encoding are what Picture::color holds, but for negative ones and such that are not
/// finite.
bool stays_half(const ColorEncoding& encoding);

/// Rows of RGBA as they come from a file: negative colours become 0 as SanitizeCounts says, unless they are kept. What
/// is not finite has no place among half floats. Thread-safe.
class HalfColors {
 public:
  HalfColors(std::uint16_t* rgba, int width, bool keep_negative = false)
      : rgba_(rgba), width_(static_cast<std::size_t>(width)), keep_negative_(keep_negative) {}

  void take_rows(int begin, int end);
  bool finite() const { return finite_; }  ///< of all rows that were taken; else they have to be read as floats
  std::uint64_t negative() const { return negative_; }
  std::uint64_t far_below() const { return far_below_; }

 private:
  std::uint16_t* rgba_;
  std::size_t width_;
  bool keep_negative_;
  std::atomic<bool> finite_ = true;
  std::atomic<std::uint64_t> negative_ = 0, far_below_ = 0;
};

}  // namespace afterglow
