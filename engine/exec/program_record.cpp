// SPDX-License-Identifier: MIT
// Records the kernels of a Program with their barriers.
#include <algorithm>
#include <set>

#include "exec/program_state.h"
#include "graph/history.h"

namespace afterglow {
namespace {

/// An image that is filled with one value and read from here on. Frames before this one may have drawn and read it.
VkImageMemoryBarrier2 before_filling(VkImage image) {
  return image_barrier(
      image,
      VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT |
          VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_2_TRANSFER_BIT,
      VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT,
      VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
      VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
}

VkImageMemoryBarrier2 after_filling(VkImage image, VkImageLayout layout) {
  return image_barrier(
      image, VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
      VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, reading_access(layout), layout);
}

}  // namespace

/// The image that barriers name for this one, or null.
VkImage Program::State::barrier_image(ImageId id, int parity) const {
  if (const GpuImage* history = history_image(id, parity)) return history->get();
  const UnboundImage* image = linear ? nullptr : arena.image(id);
  return image ? image->get() : VkImage{VK_NULL_HANDLE};
}

/// Targets, sizes and barriers: fixed until other histories are used.
void Program::State::make_commands() {
  begin.images.clear();
  for (const VkImage image : arena.linear_images()) begin.images.push_back(into_general(image));
  for (const int parity : {kEven, kOdd}) {
    auto barriers = kernel_barriers(
        plan, reads, [&](ImageId id) { return barrier_image(id, parity); }, read_layout());
    auto& commands = kernels[static_cast<std::size_t>(parity)];
    commands.clear();
    for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
      const ImageId output = plan.kernels[i].output;
      const UnboundImage* target = arena.image(output);
      const RowTargets* by_rows = arena.row_targets(output);
      const GpuImage* history = history_image(output, parity);
      std::vector<VkImageView> targets;
      if (history)
        targets = {history->view()};
      else if (by_rows)
        targets = by_rows->views();
      else if (target)
        targets = {target->view()};
      barriers[i].memory = linear && i > 0;
      KernelBarriers after;
      if (history) after.images = {before_reading(history->get(), history_layout(), writing_of(plan.kernels[i]))};
      commands.push_back(
          {.name = plan.kernels[i].name,
           .pipeline = pipelines.pipeline(compiled.index[i]),
           .rest = pipelines.rest(compiled.index[i]),
           .marks = compiled_of(i).two_draws ? &marks : nullptr,
           .layout = pipelines.layout(compiled_of(i)).pipeline.get(),
           .targets = std::move(targets),
           .rows = compiled_of(i).rows,
           .target_size = graph.images[output].size,
           .first_image_size = images[i].empty() ? Size{} : graph.images[images[i].front()].size,
           .part = parts.kernels[i],
           .group = compiled_of(i).workgroup ? std::optional(compiled_of(i).workgroup->pixels) : std::nullopt,
           .target_layout = target_layout(output),
           .turn_before = i == 0 || !plan.kernels[i - 1].dispatched,
           .turn_after = i + 1 == plan.kernels.size() || !plan.kernels[i + 1].dispatched,
           .barriers = std::move(barriers[i]),
           .after = std::move(after)});
    }
  }
}

/// Fills the previous images that have neither a frame before them nor a first image.
void Program::State::begin_recording(VkCommandBuffer commands, const Place& place) const {
  if (begins_anew()) write_set(place, kFirst, [&](ImageId id) { return look_in_first_frame(place, id); });
  if (!histories) return;
  for (const auto& history : graph.histories) {
    if (history.first != kNoImage || !lacks_previous(history)) continue;
    const VkImage image = histories->image(history.name, parity())->get();
    const VkImageMemoryBarrier2 before = before_filling(image), after = after_filling(image, history_layout());
    VkClearColorValue value{};
    for (std::size_t i = 0; i < 4; ++i) value.float32[i] = static_cast<float>(history.initial[i]);
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    afterglow::record_barriers(device, commands, &before, 1);
    device.vk().vkCmdClearColorImage(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &value, 1, &all);
    afterglow::record_barriers(device, commands, &after, 1);
  }
}

/// The one that the frame that began reads from.
VkDescriptorSet Program::State::set_of(const Place& place, std::size_t kernel) const {
  return place.descriptors.set(set_index(begins_anew() ? kFirst : parity(), kernel));
}

/// Of a kernel that is recorded by itself: others than in a whole run may stand beside it.
KernelCommands Program::State::commands_alone(std::size_t kernel) const {
  KernelCommands one = kernels[static_cast<std::size_t>(parity())][kernel];
  one.turn_before = one.turn_after = true;
  return one;
}

void Program::State::record_all(VkCommandBuffer commands, const Place& place,
                                const std::function<void(std::size_t)>& stamp) const {
  const auto& all = kernels[static_cast<std::size_t>(parity())];
  afterglow::record_barriers(device, commands, begin);
  for (std::size_t i = 0; i < all.size(); ++i) {
    record_kernel(device, commands, all[i], set_of(place, i), place.result);
    stamp(i + 1);
  }
}

void Program::record_a_pixel_each(VkCommandBuffer commands, bool backwards, int place) {
  State& s = *state_;
  const State::Place& at = s.places[static_cast<std::size_t>(place)];
  const std::size_t count = s.plan.kernels.size();
  for (std::size_t i = 0; i < count; ++i) s.holds(i).reset();
  s.begin_recording(commands, at);
  afterglow::record_barriers(s.device, commands, s.begin);
  for (std::size_t turn = 0; turn < count; ++turn) {
    const std::size_t kernel = backwards && s.linear ? count - 1 - turn : turn;
    KernelCommands one = s.commands_alone(kernel);
    one.part = {0, 0, 1, 1};
    record_kernel(s.device, commands, one, s.set_of(at, kernel), at.result);
  }
}

/// Some kernels: images that the others have made are in the layout for reading already and stay so.
void Program::State::record_some(VkCommandBuffer commands, const Place& place, const std::vector<bool>& run,
                                 const std::function<void(std::size_t)>& stamp) const {
  Plan some;
  std::vector<std::vector<ImageId>> read;
  std::set<ImageId> targets;
  for (std::size_t i = 0; i < run.size(); ++i) {
    if (!run[i]) continue;
    some.kernels.push_back(plan.kernels[i]);
    read.push_back(reads[i]);
    targets.insert(plan.kernels[i].output);
  }
  const auto image_of = [&](ImageId id) {
    return targets.contains(id) ? barrier_image(id, parity()) : VkImage{VK_NULL_HANDLE};
  };
  auto barriers = kernel_barriers(some, read, image_of, read_layout());
  KernelBarriers linear_ones;  // those that run may never have been drawn before
  for (const ImageId id : targets)
    for (const VkImage image : arena.linear_images(id)) linear_ones.images.push_back(into_general(image));
  afterglow::record_barriers(device, commands, linear_ones);
  for (std::size_t i = 0, next = 0; i < run.size(); ++i) {
    if (run[i]) {
      KernelCommands one = commands_alone(i);
      one.barriers = std::move(barriers[next++]);
      one.barriers.memory = linear;
      record_kernel(device, commands, one, set_of(place, i), place.result);
    }
    stamp(i + 1);
  }
}

void Program::record_again(VkCommandBuffer commands, std::size_t kernel, VkQueryPool timestamps, int place) const {
  const State& s = *state_;
  const auto stamp = [&](std::uint32_t query) {
    if (timestamps == VK_NULL_HANDLE) return;
    s.device.vk().vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, timestamps, query);
  };
  if (timestamps != VK_NULL_HANDLE) s.device.vk().vkCmdResetQueryPool(commands, timestamps, 0, 2);
  std::vector<bool> run(s.plan.kernels.size(), false);
  run[kernel] = true;
  stamp(0);
  s.record_some(commands, s.places[static_cast<std::size_t>(place)], run, [&](std::size_t done) {
    if (done == kernel + 1) stamp(1);
  });
  // Its readers do not follow.
  const ImageId output = s.plan.kernels[kernel].output;
  if (s.linear || !s.arena.image(output)) return;
  KernelBarriers after;
  after.images = {before_reading(s.arena.image(output)->get(), s.read_layout(), writing_of(s.plan.kernels[kernel]))};
  afterglow::record_barriers(s.device, commands, after);
}

}  // namespace afterglow
