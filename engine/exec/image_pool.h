// SPDX-License-Identifier: MIT
// Images between kernels that programs of one device share, so that a program which takes another's place finds what
// that has made.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "core/hash.h"
#include "gpu/image.h"
#include "gpu/row_targets.h"

namespace afterglow {

/// An image with memory of its own, and what it holds.
struct PooledImage {
  Memory memory;  // before the images: freed after them
  UnboundImage image;
  RowTargets rows;            ///< none of an image that is written one row at a time
  std::optional<Hash> holds;  ///< key of its pixels (graph/changes.h); none: anything. Of the drawing thread alone
  VkMemoryRequirements needs() const { return rows.rows() > 1 ? rows.needs() : image.needs(); }
};

/// Keeps no image alive: it goes with the last program that uses it. Thread-safe, but programs that share images must
/// be run on one thread. The device must outlive it.
class ImagePool {
 public:
  /// Null when no program has it. `key` says all that the image is made for: kernel, size, format, usage, and no
  /// values.
  std::shared_ptr<PooledImage> find(const Hash& key);
  /// The image from now on; the one that another thread was quicker to add, if one was.
  std::shared_ptr<PooledImage> add(const Hash& key, PooledImage made);

  struct Counters {
    std::uint64_t made = 0, alive = 0, bytes = 0;  ///< bytes: of those alive
  };
  Counters counters() const;

 private:
  mutable std::mutex mutex_;
  std::map<Hash, std::weak_ptr<PooledImage>> images_;
  std::uint64_t made_ = 0;
};

}  // namespace afterglow
