// SPDX-License-Identifier: MIT
#include <utility>

#include "core/large_pages.h"
#include "image/reader.h"
#include "image/writer.h"

namespace afterglow {

namespace {

template <class Kind>
auto take_last(Kind& kind) {
  ++kind.out;
  typename decltype(kind.free)::value_type last;
  if (kind.free.empty()) return last;
  last = std::move(kind.free.back());
  kind.free.pop_back();
  return last;
}

}  // namespace

/// Memory of one kind for so many values. What was for another size goes first.
template <class Values>
Values PixelMemory::take(Kind<Values> Kept::*kind, std::size_t count) {
  Kept others;  // goes after the lock
  Values values;
  {
    const std::lock_guard lock(mutex_);
    if (count_ != count) {
      std::swap(others.pixels.free, kept_.pixels.free);
      std::swap(others.codes.free, kept_.codes.free);
      std::swap(others.halves.free, kept_.halves.free);
    }
    count_ = count;
    values = take_last(kept_.*kind);
  }
  others = {};
  resize_for_picture(values, count);
  return values;
}

std::vector<float> PixelMemory::take(std::size_t count) { return take(&Kept::pixels, count); }
UnsetVector<std::uint16_t> PixelMemory::take_halves(std::size_t count) { return take(&Kept::halves, count); }

UnsetVector<std::uint8_t> PixelMemory::take_codes() {
  const std::lock_guard lock(mutex_);
  return take_last(kept_.codes);
}

void PixelMemory::give(Picture&& picture) {
  Picture done = std::move(picture);  // all of it goes, whoever holds what is left
  const std::lock_guard lock(mutex_);
  const auto keep = [this](auto& kind, auto& values) {
    if (values.empty() || kind.out == 0) return;
    --kind.out;
    if (values.size() == count_) kind.free.push_back(std::move(values));
  };
  keep(kept_.pixels, done.color.pixels);
  keep(kept_.halves, done.halves);
  keep(kept_.codes, done.unorm8);
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
