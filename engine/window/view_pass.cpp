// SPDX-License-Identifier: MIT
#include "window/view_pass.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gpu/error.h"
#include "gpu/fullscreen_vertex.h"
#include "gpu/pipeline.h"
#include "gpu/swapchain.h"
#include "view.frag.h"

namespace afterglow {

namespace {

constexpr std::uint32_t kImages = 2;
constexpr VkDescriptorType kImageType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;

/// As view.frag declares it.
struct Push {
  std::array<float, 4> outside, below, above, not_finite;
  std::array<float, 2> origin;
  float scale, checker;
  std::array<std::int32_t, 2> picture, shown_size, compared_size;
  std::int32_t channel, flags;
};
static_assert(sizeof(Push) == 112);

enum Flag {
  kFalseColor = 1,
  kCompare = 2,
  kHorizontal = 4,
  kEncode = 8,
  kGray = 16,
  kChecker = 32,
  kDifference = 64,
  kSmooth = 128,
  kZoned = 256,
  kGamma = 512
};

float to_linear(float code) { return code <= 0.04045f ? code / 12.92f : std::pow((code + 0.055f) / 1.055f, 2.4f); }

std::array<float, 4> color_and(const ViewColor& color, double w) {
  return {to_linear(color[0]), to_linear(color[1]), to_linear(color[2]), static_cast<float>(w)};
}

std::array<std::int32_t, 2> pair_of(Size size) { return {size.width, size.height}; }

/// Where the border of a comparison lies, in pixels of the target.
double border_of(const ViewFrame& frame, const ViewPlacement& place) {
  const Point at = to_screen(place, {frame.view.wipe * frame.picture.width, frame.view.wipe * frame.picture.height});
  return frame.view.wipe_vertical ? at.y + frame.area.y : at.x + frame.area.x;
}

Push push_of(const ViewFrame& frame, bool encode) {
  const View& view = frame.view;
  const ViewPlacement place = placement(view, frame.picture, frame.area.size());
  const bool compare = view.compare != Compare::none && frame.compared.has_value();
  const bool difference = compare && view.by == CompareBy::difference;
  Push push{};
  push.outside = color_and(frame.outside, 1 / view.gamma);
  push.below = color_and(kMarkBelow, std::exp2(view.exposure));
  push.above = color_and(kMarkAbove, border_of(frame, place));
  push.not_finite = color_and(kMarkNotFinite, frame.pixel_scale);
  push.origin = {static_cast<float>(place.origin.x + frame.area.x), static_cast<float>(place.origin.y + frame.area.y)};
  push.scale = static_cast<float>(place.scale);
  push.checker = 12 * frame.pixel_scale;
  push.picture = pair_of(frame.picture);
  push.shown_size = pair_of(frame.shown.size);
  push.compared_size = pair_of(compare ? frame.compared->size : frame.shown.size);
  push.channel = static_cast<std::int32_t>(view.channel);
  push.flags = (view.smooth ? kSmooth : 0) | (view.marks == Marks::range ? kFalseColor : 0) |
               (view.marks == Marks::stops ? kZoned : 0) | (view.gamma != 1 ? kGamma : 0) |
               (compare && !difference ? kCompare : 0) | (difference ? kDifference : 0) |
               (view.wipe_vertical ? kHorizontal : 0) | (encode ? kEncode : 0) |
               (frame.background == ViewBackground::gray ? kGray : 0) |
               (frame.background == ViewBackground::checker ? kChecker : 0);
  return push;
}

}  // namespace

struct ViewPass::State {
  const Device& device;
  bool encode = true;
  DrawLayout layout;
  PipelineHandle pipeline;
  SamplerHandle sampler;
  DescriptorPoolHandle pool;
  std::vector<VkDescriptorSet> sets;  // of each slot, kMostFrames in a row

  Result<void> make_pipeline(VkFormat target);
  Result<void> make_sets(std::size_t count);
  void bind(VkDescriptorSet set, const std::array<ViewImage, kImages>& images) const;
  void draw(VkCommandBuffer commands, VkDescriptorSet set, const ViewFrame& frame) const;
};

Result<void> ViewPass::State::make_pipeline(VkFormat target) {
  AFTERGLOW_TRY(layout,
                create_draw_layout(device, {.images = std::vector(kImages, kImageType), .push_bytes = sizeof(Push)}));
  AFTERGLOW_TRY(const auto vertex, create_shader_module(device, kFullscreenVertex, "view"));
  AFTERGLOW_TRY(const auto fragment, create_shader_module(device, kViewFrag, "view"));
  AFTERGLOW_TRY(pipeline, create_draw_pipeline(device, layout, vertex.get(), fragment.get(), {target}, "view"));
  AFTERGLOW_TRY(sampler, create_sampler(device, VK_FILTER_NEAREST));
  return {};
}

Result<void> ViewPass::State::make_sets(std::size_t count) {
  const auto number = static_cast<std::uint32_t>(count);
  const VkDescriptorPoolSize size{kImageType, kImages * number};
  const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                        .maxSets = number,
                                        .poolSizeCount = 1,
                                        .pPoolSizes = &size};
  VkDescriptorPool made = VK_NULL_HANDLE;
  AFTERGLOW_VK(device.vk().vkCreateDescriptorPool(device.handle(), &info, nullptr, &made),
               "cannot create descriptors of the view");
  pool = DescriptorPoolHandle(device, made);
  this->sets.resize(count);
  for (VkDescriptorSet& allocated : this->sets) {
    const VkDescriptorSetLayout set = layout.set.get();
    const VkDescriptorSetAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                               .descriptorPool = made,
                                               .descriptorSetCount = 1,
                                               .pSetLayouts = &set};
    AFTERGLOW_VK(device.vk().vkAllocateDescriptorSets(device.handle(), &allocate, &allocated),
                 "cannot create descriptors of the view");
  }
  return {};
}

/// Always written: an image that took the place of another may have got the same handle.
void ViewPass::State::bind(VkDescriptorSet set, const std::array<ViewImage, kImages>& images) const {
  std::array<VkDescriptorImageInfo, kImages> infos{};
  std::array<VkWriteDescriptorSet, kImages> writes{};
  for (std::uint32_t i = 0; i < kImages; ++i) {
    infos[i] = {sampler.get(), images[i].view, images[i].layout};
    writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                 .dstSet = set,
                 .dstBinding = i + 1,
                 .descriptorCount = 1,
                 .descriptorType = kImageType,
                 .pImageInfo = &infos[i]};
  }
  device.vk().vkUpdateDescriptorSets(device.handle(), kImages, writes.data(), 0, nullptr);
}

void ViewPass::State::draw(VkCommandBuffer commands, VkDescriptorSet set, const ViewFrame& frame) const {
  bind(set, {frame.shown, frame.compared.value_or(frame.shown)});
  const auto x = static_cast<float>(frame.area.x), y = static_cast<float>(frame.area.y);
  const auto width = static_cast<std::uint32_t>(frame.area.width);
  const auto height = static_cast<std::uint32_t>(frame.area.height);
  const VkViewport viewport{x, y, static_cast<float>(width), static_cast<float>(height), 0, 1};
  const VkRect2D scissor{{frame.area.x, frame.area.y}, {width, height}};
  device.vk().vkCmdSetViewport(commands, 0, 1, &viewport);
  device.vk().vkCmdSetScissor(commands, 0, 1, &scissor);
  device.vk().vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.get());
  device.vk().vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout.pipeline.get(), 0, 1, &set, 0,
                                      nullptr);
  const Push push = push_of(frame, encode);
  device.vk().vkCmdPushConstants(commands, layout.pipeline.get(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push, &push);
  device.vk().vkCmdDraw(commands, 3, 1, 0, 0);
}

Result<std::unique_ptr<ViewPass>> ViewPass::create(const Device& device, VkFormat target, std::size_t slots) {
  std::unique_ptr<State> state(new State{.device = device});
  state->encode = !encodes_srgb(target);
  AFTERGLOW_CHECK(state->make_pipeline(target));
  AFTERGLOW_CHECK(state->make_sets(slots * kMostFrames));
  return std::unique_ptr<ViewPass>(new ViewPass(std::move(state)));
}

ViewPass::ViewPass(std::unique_ptr<State> state) : state_(std::move(state)) {}
ViewPass::~ViewPass() = default;

void ViewPass::record(VkCommandBuffer commands, std::size_t slot, std::span<const ViewFrame> frames) {
  State& s = *state_;
  s.device.begin_label(commands, "view");
  for (std::size_t i = 0; i < std::min(frames.size(), kMostFrames); ++i)
    if (frames[i].area.size().area() > 0) s.draw(commands, s.sets[slot * kMostFrames + i], frames[i]);
  s.device.end_label(commands);
}

}  // namespace afterglow
