// SPDX-License-Identifier: MIT
#include "exec/arena.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/memory_limit.h"
#include "core/text.h"
#include "graph/history.h"

namespace afterglow {

namespace {

Placement place_some(const std::vector<Block>& blocks, const std::vector<int>& chosen, bool share) {
  std::vector<Block> some;
  for (const int i : chosen) some.push_back(blocks[i]);
  return place(some, share);
}

}  // namespace

std::vector<ArenaGroup> group_blocks(const std::vector<Block>& blocks, bool share, std::uint64_t max_allocation) {
  std::vector<int> rest(blocks.size());
  std::iota(rest.begin(), rest.end(), 0);
  std::vector<ArenaGroup> groups;
  while (!rest.empty()) {
    Placement placement = place_some(blocks, rest, share);
    if (placement.total <= max_allocation || rest.size() == 1) {
      groups.push_back({std::move(rest), std::move(placement)});
      break;
    }
    const auto largest = std::ranges::max_element(rest, {}, [&](int i) { return blocks[i].size; });
    groups.push_back({{*largest}, place_some(blocks, {*largest}, share)});
    rest.erase(largest);
  }
  return groups;
}

ImageDesc Arena::desc_of(const Graph& graph, ImageId id, const ArenaOptions& options) {
  const VkImageUsageFlags more = (options.readable ? VK_IMAGE_USAGE_TRANSFER_SRC_BIT : 0) |
                                 (options.storage || options.stored.contains(id) ? VK_IMAGE_USAGE_STORAGE_BIT : 0);
  return {.name = graph.images[id].name,
          .size = graph.images[id].size,
          .format = float_format(options.channels.empty() ? 4 : options.channels[static_cast<std::size_t>(id)],
                                 options.half && !is_precise(graph, id)),
          .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | more,
          .tiling = options.rows.empty() ? VK_IMAGE_TILING_OPTIMAL : VK_IMAGE_TILING_LINEAR};
}

std::vector<Arena::Wanted> Arena::wanted(const Device& device, const Graph& graph, const Plan& plan,
                                         const ArenaOptions& options) {
  std::vector<Wanted> out;
  for (std::size_t i = 0; i < plan.transient.size(); ++i) {
    const ImageId id = plan.transient[i];
    if (id == graph.result || history_of_next(graph, id)) continue;
    const ImageDesc desc = desc_of(graph, id, options);
    out.push_back({.id = id,
                   .desc = desc,
                   .rows = options.rows.empty() ? 1 : RowTargets::possible(device, desc, options.rows[i]),
                   .key = options.pool ? options.keys[i] : Hash{},
                   .lifetime = plan.lifetimes[i]});
  }
  return out;
}

Result<void> Arena::check_memory(const ArenaOptions& options) const {
  if (memory_.arena <= options.max_memory) return {};
  return Error{ErrorKind::io, fmt::format("the stack needs {} for its images, more than the {}",
                                          needed_memory(memory_.arena), allowed_memory(options.max_memory))};
}

Result<Arena> Arena::create(const Device& device, const Graph& graph, const Plan& plan, const ArenaOptions& options) {
  Arena out;
  out.linear_ = !options.rows.empty();
  const auto wanted = Arena::wanted(device, graph, plan, options);
  AFTERGLOW_CHECK(options.pool ? out.make_pooled(device, wanted, options) : out.make_own(device, wanted, options));
  return out;
}

/// Nothing is allocated before all is known to fit.
Result<void> Arena::make_pooled(const Device& device, const std::vector<Wanted>& wanted, const ArenaOptions& options) {
  std::vector<PooledImage> fresh(wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    auto& known = pooled_[wanted[i].id];
    known = options.pool->find(wanted[i].key);
    if (!known) {
      AFTERGLOW_TRY(fresh[i].image, UnboundImage::create(device, wanted[i].desc));
      if (wanted[i].rows > 1) {
        AFTERGLOW_TRY(fresh[i].rows, RowTargets::create(device, fresh[i].image, wanted[i].rows));
      }
    }
    memory_.arena += known ? known->needs().size : fresh[i].needs().size;
  }
  memory_.sum = memory_.lower_bound = memory_.arena;
  AFTERGLOW_CHECK(check_memory(options));
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    auto& known = pooled_[wanted[i].id];
    if (known) continue;
    PooledImage& made = fresh[i];
    AFTERGLOW_TRY(made.memory, Memory::allocate(device, made.needs(), HostAccess::none, "the images of the stack"));
    AFTERGLOW_CHECK(made.image.bind(device, made.memory.get(), 0));
    if (made.rows.rows() > 1) AFTERGLOW_CHECK(made.rows.bind(device, made.memory.get(), 0));
    known = options.pool->add(wanted[i].key, std::move(made));
  }
  return {};
}

Result<void> Arena::make_own(const Device& device, const std::vector<Wanted>& wanted, const ArenaOptions& options) {
  std::vector<Block> blocks;
  std::uint32_t memory_types = ~0u;
  for (const auto& [id, desc, rows, key, lifetime] : wanted) {
    AFTERGLOW_TRY(UnboundImage image, UnboundImage::create(device, desc));
    VkMemoryRequirements needs = image.needs();
    if (rows > 1) {
      AFTERGLOW_TRY(RowTargets targets, RowTargets::create(device, image, rows));
      needs = targets.needs();
      row_targets_.emplace(id, std::move(targets));
    }
    blocks.push_back({needs.size, needs.alignment, lifetime.first, lifetime.last});
    memory_types &= needs.memoryTypeBits;
    images_.emplace(id, std::move(image));
  }

  const auto groups = group_blocks(blocks, options.share, device.max_allocation());
  for (const auto& group : groups) memory_.arena += group.placement.total;
  const Placement all = place(blocks, options.share);
  memory_.sum = all.sum;
  memory_.lower_bound = all.lower_bound;
  AFTERGLOW_CHECK(check_memory(options));
  for (const auto& group : groups) {
    const VkMemoryRequirements needs{group.placement.total, 0, memory_types};
    AFTERGLOW_TRY(Memory memory, Memory::allocate(device, needs, HostAccess::none, "the images of the stack"));
    for (std::size_t i = 0; i < group.blocks.size(); ++i) {
      const ImageId id = wanted[static_cast<std::size_t>(group.blocks[i])].id;
      AFTERGLOW_CHECK(images_.at(id).bind(device, memory.get(), group.placement.offsets[i]));
      if (const auto targets = row_targets_.find(id); targets != row_targets_.end())
        AFTERGLOW_CHECK(targets->second.bind(device, memory.get(), group.placement.offsets[i]));
    }
    allocations_.push_back(std::move(memory));
  }
  return {};
}

PooledImage* Arena::pooled(ImageId id) const {
  const auto found = pooled_.find(id);
  return found == pooled_.end() ? nullptr : found->second.get();
}

const UnboundImage* Arena::image(ImageId id) const {
  if (const PooledImage* from_pool = pooled(id)) return &from_pool->image;
  const auto found = images_.find(id);
  return found == images_.end() ? nullptr : &found->second;
}

const RowTargets* Arena::row_targets(ImageId id) const {
  if (const PooledImage* from_pool = pooled(id)) return from_pool->rows.rows() > 1 ? &from_pool->rows : nullptr;
  const auto found = row_targets_.find(id);
  return found == row_targets_.end() ? nullptr : &found->second;
}

std::vector<VkImage> Arena::linear_images(ImageId id) const {
  std::vector<VkImage> out;
  const UnboundImage* found = linear_ ? image(id) : nullptr;
  if (!found) return out;
  out.push_back(found->get());
  if (const RowTargets* targets = row_targets(id))
    for (int k = 0; k < targets->rows(); ++k) out.push_back(targets->image(k));
  return out;
}

std::vector<VkImage> Arena::linear_images() const {
  std::vector<VkImage> out;
  const auto add = [&](ImageId id) {
    for (const VkImage one : linear_images(id)) out.push_back(one);
  };
  for (const auto& [id, image] : images_) add(id);
  for (const auto& [id, image] : pooled_) add(id);
  return out;
}

}  // namespace afterglow
