#include "exec/arena.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "gpu/error.h"
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

Result<Arena> Arena::create(const Device& device, const Graph& graph, const Plan& plan, const ArenaOptions& options) {
  Arena out;
  std::vector<ImageId> ids;
  std::vector<Block> blocks;
  std::uint32_t memory_types = ~0u;
  out.linear_ = !options.rows.empty();
  for (std::size_t i = 0; i < plan.transient.size(); ++i) {
    const ImageId id = plan.transient[i];
    if (id == graph.result || history_of_next(graph, id)) continue;
    const VkImageUsageFlags more =
        (options.readable ? VK_IMAGE_USAGE_TRANSFER_SRC_BIT : 0) | (options.storage ? VK_IMAGE_USAGE_STORAGE_BIT : 0);
    const ImageDesc desc{.name = graph.images[id].name,
                         .size = graph.images[id].size,
                         .format = options.format,
                         .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | more,
                         .tiling = out.linear_ ? VK_IMAGE_TILING_LINEAR : VK_IMAGE_TILING_OPTIMAL};
    AFTERGLOW_TRY(UnboundImage image, UnboundImage::create(device, desc));
    VkMemoryRequirements needs = image.needs();
    const int rows = out.linear_ ? RowTargets::possible(device, desc, options.rows[i]) : 1;
    if (rows > 1) {
      AFTERGLOW_TRY(RowTargets targets, RowTargets::create(device, image, rows));
      needs = targets.needs();
      out.row_targets_.emplace(id, std::move(targets));
    }
    blocks.push_back({needs.size, needs.alignment, plan.lifetimes[i].first, plan.lifetimes[i].last});
    memory_types &= needs.memoryTypeBits;
    ids.push_back(id);
    out.images_.emplace(id, std::move(image));
  }

  const auto groups = group_blocks(blocks, options.share, device.max_allocation());
  for (const auto& group : groups) out.memory_.arena += group.placement.total;
  const Placement all = place(blocks, options.share);
  out.memory_.sum = all.sum;
  out.memory_.lower_bound = all.lower_bound;
  if (out.memory_.arena > options.max_memory) {
    return Error{ErrorKind::io,
                 fmt::format("the stack needs {} for its images, more than the {} allowed (--max-memory)",
                             bytes_text(out.memory_.arena), bytes_text(options.max_memory))};
  }
  for (const auto& group : groups) {
    const VkMemoryRequirements needs{group.placement.total, 0, memory_types};
    AFTERGLOW_TRY(Memory memory, Memory::allocate(device, needs, HostAccess::none, "the images of the stack"));
    for (std::size_t i = 0; i < group.blocks.size(); ++i) {
      const ImageId id = ids[group.blocks[i]];
      AFTERGLOW_CHECK(out.images_.at(id).bind(device, memory.get(), group.placement.offsets[i]));
      if (const auto targets = out.row_targets_.find(id); targets != out.row_targets_.end())
        AFTERGLOW_CHECK(targets->second.bind(device, memory.get(), group.placement.offsets[i]));
    }
    out.allocations_.push_back(std::move(memory));
  }
  return out;
}

const UnboundImage* Arena::image(ImageId id) const {
  const auto found = images_.find(id);
  return found == images_.end() ? nullptr : &found->second;
}

const RowTargets* Arena::row_targets(ImageId id) const {
  const auto found = row_targets_.find(id);
  return found == row_targets_.end() ? nullptr : &found->second;
}

std::vector<VkImage> Arena::linear_images() const {
  std::vector<VkImage> out;
  if (!linear_) return out;
  for (const auto& [id, image] : images_) out.push_back(image.get());
  for (const auto& [id, targets] : row_targets_)
    for (int k = 0; k < targets.rows(); ++k) out.push_back(targets.image(k));
  return out;
}

}  // namespace afterglow
