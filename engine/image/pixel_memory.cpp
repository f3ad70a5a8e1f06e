// SPDX-License-Identifier: MIT
#include "image/pixel_memory.h"

#include <utility>

namespace afterglow {

std::vector<float> PixelMemory::take(std::size_t count) {
  std::vector<std::vector<float>> others;  // go after the lock
  {
    const std::lock_guard lock(mutex_);
    if (count_ != count) others.swap(free_);
    count_ = count;
    if (!free_.empty()) {
      std::vector<float> pixels = std::move(free_.back());
      free_.pop_back();
      return pixels;
    }
  }
  others.clear();
  return std::vector<float>(count);
}

void PixelMemory::give(Picture&& picture) {
  Picture done = std::move(picture);  // all of it goes, whoever holds what is left
  std::vector<float> pixels = std::move(done.color.pixels);
  const std::lock_guard lock(mutex_);
  if (!pixels.empty() && pixels.size() == count_) free_.push_back(std::move(pixels));
}

}  // namespace afterglow
