// SPDX-License-Identifier: MIT
#include <utility>

#include "core/large_pages.h"
#include "image/reader.h"
#include "image/writer.h"

namespace afterglow {

std::vector<float> PixelMemory::take(std::size_t count) {
  std::vector<std::vector<float>> others;  // go after the lock
  std::vector<std::vector<std::uint8_t>> other_codes;
  {
    const std::lock_guard lock(mutex_);
    if (count_ != count) {
      others.swap(free_);
      other_codes.swap(free_codes_);
    }
    count_ = count;
    if (!free_.empty()) {
      std::vector<float> pixels = std::move(free_.back());
      free_.pop_back();
      return pixels;
    }
  }
  others.clear();
  other_codes.clear();
  std::vector<float> pixels;
  resize_for_picture(pixels, count);
  return pixels;
}

std::vector<std::uint8_t> PixelMemory::take_codes() {
  const std::lock_guard lock(mutex_);
  if (free_codes_.empty()) return {};
  std::vector<std::uint8_t> codes = std::move(free_codes_.back());
  free_codes_.pop_back();
  return codes;
}

std::vector<std::uint16_t> PixelMemory::take_halves(std::size_t count) {
  std::vector<std::uint16_t> halves;
  {
    const std::lock_guard lock(mutex_);
    if (!free_halves_.empty()) {
      halves = std::move(free_halves_.back());
      free_halves_.pop_back();
    }
  }
  resize_for_picture(halves, count);
  return halves;
}

void PixelMemory::give(Picture&& picture) {
  Picture done = std::move(picture);  // all of it goes, whoever holds what is left
  std::vector<float> pixels = std::move(done.color.pixels);
  std::vector<std::uint8_t> codes = std::move(done.unorm8);
  std::vector<std::uint16_t> halves = std::move(done.halves);
  const std::lock_guard lock(mutex_);
  if (!halves.empty()) free_halves_.push_back(std::move(halves));
  if (!codes.empty() && codes.size() == count_) free_codes_.push_back(std::move(codes));
  if (!pixels.empty() && pixels.size() == count_) free_.push_back(std::move(pixels));
}

WorkMemory::Block WorkMemory::take(std::size_t size) {
  Block block;
  {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      block = std::move(free_.back());
      free_.pop_back();
    }
  }
  if (block.size >= size && block.size / 2 <= size) return block;
  block = {};  // before the new one is made: the two need not exist at once
  block = {std::make_unique_for_overwrite<std::uint8_t[]>(size), size};
  use_large_pages(block.bytes.get(), size);
  return block;
}

void WorkMemory::give(Block block) {
  const std::lock_guard lock(mutex_);
  free_.push_back(std::move(block));
}

}  // namespace afterglow
