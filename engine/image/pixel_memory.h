// SPDX-License-Identifier: MIT
// Memory of pictures that are done, for those that come: the system clears what it hands out, which takes longer than
// to decode a picture into it.
#pragma once

#include <cstddef>
#include <mutex>
#include <vector>

#include "image/picture.h"

namespace afterglow {

/// Holds no more than was in use at a time, of one size. Thread-safe.
class PixelMemory {
 public:
  /// So many values; they may be anything.
  std::vector<float> take(std::size_t count);
  /// Takes the picture, and keeps what it has of that memory.
  void give(Picture&& picture);

 private:
  std::mutex mutex_;
  std::size_t count_ = 0;  ///< that was asked for last
  std::vector<std::vector<float>> free_;
};

}  // namespace afterglow
