// SPDX-License-Identifier: MIT
// What is known of a picture: its brightest value, and whether it is opaque. Found while it is packed for the device.
#pragma once

#include <atomic>
#include <cstdint>

#include "exec/program.h"

namespace afterglow {

/// Collects rows of one picture; rows may come from several threads.
class Brightest {
 public:
  /// Interleaved floats; of four or more channels the first three count, of fewer all of them.
  void add_row(const float* row, int channels, int width);

  /// The largest red, green or blue that the device will read from images of this storage. NaN when some value is
  /// negative (−0 too) or not finite.
  float value(Storage storage) const;

  /// Is every alpha exactly 1? Rows of less than four channels have none.
  bool opaque() const { return opaque_.load(std::memory_order_relaxed); }

 private:
  std::atomic<bool> opaque_{true};
  std::atomic<std::uint32_t> bits_{
      0};  ///< of floats; as integers, those that are ≥ 0 sort as they do, all others above them
};

}  // namespace afterglow
