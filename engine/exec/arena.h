// SPDX-License-Identifier: MIT
// Memory of the images between kernels: as few allocations as the device allows, shared where lifetimes do not overlap.
#pragma once

#include <map>
#include <set>
#include <vector>

#include "exec/image_pool.h"
#include "exec/program.h"
#include "gpu/image.h"
#include "gpu/row_targets.h"

namespace afterglow {

struct ArenaOptions {
  bool half = false;  ///< images hold 16-bit floats
  /// Channels that each image of the graph stores, by its id. Empty: four.
  std::vector<int> channels{};
  bool share = true;
  bool readable = false;     ///< images may be copied from
  bool storage = false;      ///< images may be read as storage images
  std::set<ImageId> stored;  ///< those that compute kernels make
  /// Wanted for the target of each kernel, parallel to the plan's kernels: rows that one invocation makes. Empty: one,
  /// and images are tiled as the device likes. Else images are linear and stay in GENERAL.
  std::vector<int> rows;
  std::uint64_t max_memory = 0;
  /// Images come from here, each with memory of its own, under these keys, parallel to the plan's kernels. Null: all
  /// are the arena's alone.
  ImagePool* pool = nullptr;
  std::vector<Hash> keys{};
};

class Arena {
 public:
  /// Makes every image of `plan.transient` but the result, which is the caller's, and what histories keep. Errors:
  /// device (limits, out of memory), io (over `max_memory`, before anything is allocated).
  static Result<Arena> create(const Device& device, const Graph& graph, const Plan& plan, const ArenaOptions& options);
  Arena() = default;
  /// What the image of a kernel is made as.
  static ImageDesc desc_of(const Graph& graph, ImageId id, const ArenaOptions& options);

  /// Null for images that are not in the arena.
  const UnboundImage* image(ImageId id) const;
  /// The draw targets of an image that is written several rows at a time; null for the others.
  const RowTargets* row_targets(ImageId id) const;
  /// Null for images that are not from the pool.
  PooledImage* pooled(ImageId id) const;
  /// Every VkImage of a linear arena; their content may be thrown away before the first kernel.
  std::vector<VkImage> linear_images() const;
  /// Those that are this image of a linear arena.
  std::vector<VkImage> linear_images(ImageId id) const;
  const ProgramMemory& memory() const { return memory_; }
  int images() const { return static_cast<int>(images_.size() + pooled_.size()); }
  int allocations() const { return static_cast<int>(allocations_.size() + pooled_.size()); }

 private:
  /// An image that is to be made for a kernel's target.
  struct Wanted {
    ImageId id = kNoImage;
    ImageDesc desc;
    int rows = 1;
    Hash key;
    Plan::Lifetime lifetime;
  };
  static std::vector<Wanted> wanted(const Device& device, const Graph& graph, const Plan& plan,
                                    const ArenaOptions& options);
  Result<void> check_memory(const ArenaOptions& options) const;
  Result<void> make_pooled(const Device& device, const std::vector<Wanted>& wanted, const ArenaOptions& options);
  Result<void> make_own(const Device& device, const std::vector<Wanted>& wanted, const ArenaOptions& options);

  std::vector<Memory> allocations_;  // before the images: freed after them
  std::map<ImageId, UnboundImage> images_;
  std::map<ImageId, RowTargets> row_targets_;
  std::map<ImageId, std::shared_ptr<PooledImage>> pooled_;
  bool linear_ = false;
  ProgramMemory memory_;
};

/// Blocks (by index) that go into one allocation, and where.
struct ArenaGroup {
  std::vector<int> blocks;
  Placement placement;
};
/// All blocks in one group when that is at most `max_allocation` large; else the largest blocks get allocations of
/// their own. Pure.
std::vector<ArenaGroup> group_blocks(const std::vector<Block>& blocks, bool share, std::uint64_t max_allocation);

}  // namespace afterglow
