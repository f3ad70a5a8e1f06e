// SPDX-License-Identifier: MIT
#include "window/view_pass.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "fill.frag.h"
#include "gpu/error.h"
#include "gpu/fullscreen_vertex.h"
#include "gpu/pipeline.h"
#include "gpu/swapchain.h"
#include "image/srgb.h"
#include "view.frag.h"
#include "window/plain_pass.h"
#include "window/view_table.h"
#include "window/window_tiles.h"

namespace afterglow {

namespace {

constexpr std::uint32_t kImages = 2, kBindings = 3;  ///< pictures; and the table of a display
constexpr std::size_t kSetsOfFrame = 2;              ///< what is shown; what it is compared with beside a border
constexpr VkDescriptorType kImageType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;

/// As view.frag declares it.
struct Push {
  std::array<float, 4> power, below, above, not_finite;
  std::array<float, 2> origin;
  float scale, checker;
  std::array<std::int32_t, 2> picture, shown_size, compared_size;
  std::int32_t planes, unused;
  std::array<float, 4> shaper;
};
static_assert(sizeof(Push) == 128);  // devices have no more for sure

/// As fill.frag declares it.
using ViewFill = std::array<float, 4>;

enum Flag {
  kFalseColor = 1,
  kDifference = 2,
  kEncode = 4,
  kGray = 8,
  kChecker = 16,
  kZoned = 64,
  kGamma = 128,
  kTable = 256
};
enum Reads { kNearest, kSmooth, kMean };

/// The shader's specialisation constants: flags, channel, how `shown` and `compared` are read.
using Constants = std::array<std::int32_t, 4>;

constexpr ViewColor kBorder{0.906332f, 0.906332f, 0.906332f}, kBesideBorder{0.151704f, 0.151704f, 0.151704f};

float to_linear(float code) { return static_cast<float>(srgb_to_linear(code)); }

std::array<float, 4> color_and(const ViewColor& color, double w) {
  return {to_linear(color[0]), to_linear(color[1]), to_linear(color[2]), static_cast<float>(w)};
}

std::array<std::int32_t, 2> pair_of(Size size) { return {size.width, size.height}; }

/// The pixels of the target whose middles lie from `from` to `to`, the first and the one behind the last.
std::array<int, 2> middles_between(double from, double to) {
  return {static_cast<int>(std::ceil(from - 0.5)), static_cast<int>(std::ceil(to - 0.5))};
}

/// What a view shows, and where on the target.
struct Place {
  Point origin;  ///< of the picture
  double scale = 1;
  Rect pixels;        ///< of the picture, as far as they lie in the frame's area
  double border = 0;  ///< of a wipe
};

Place place_of(const ViewFrame& frame) {
  const ViewPlacement at = placement(frame.view, frame.picture, frame.area.size());
  Place out{.origin = {at.origin.x + frame.area.x, at.origin.y + frame.area.y}, .scale = at.scale};
  // Held near the area, so that a picture that is magnified beyond it stays within whole numbers.
  const auto side = [](double origin, double length, int from, int size) {
    return middles_between(std::max(origin, from - 1.0), std::min(origin + length, from + size + 1.0));
  };
  const auto [left, right] = side(out.origin.x, at.scale * frame.picture.width, frame.area.x, frame.area.width);
  const auto [top, bottom] = side(out.origin.y, at.scale * frame.picture.height, frame.area.y, frame.area.height);
  out.pixels = common_part({left, top, std::max(right - left, 0), std::max(bottom - top, 0)}, frame.area);
  const bool across = frame.view.wipe_vertical;
  const double length = at.scale * frame.view.wipe * (across ? frame.picture.height : frame.picture.width);
  out.border = length + (across ? out.origin.y : out.origin.x);
  return out;
}

/// The pixels whose middles lie between these two along the border's direction of a wipe.
Rect strip_between(const Place& place, bool vertical, double from, double to) {
  const Rect& all = place.pixels;
  const int first = vertical ? all.y : all.x, length = vertical ? all.height : all.width;
  const auto [begin, end] = middles_between(std::clamp<double>(from, first - 1, first + length + 1),
                                            std::clamp<double>(to, first - 1, first + length + 1));
  const Rect cut = vertical ? Rect{all.x, begin, all.width, end - begin} : Rect{begin, all.y, end - begin, all.height};
  return common_part(cut, all);
}

/// A part of the picture that is drawn at once: an image, or how far two are apart.
struct Strip {
  Rect pixels;
  std::array<ViewImage, kImages> images;
  bool difference = false;
};

/// What is shown, and what it is compared with beside a border.
std::vector<Strip> strips_of(const ViewFrame& frame, const Place& place) {
  const bool compares = frame.view.compare != Compare::none && frame.compared.has_value();
  if (!compares) return {{place.pixels, {frame.shown, frame.shown}}};
  const ViewImage& other = *frame.compared;
  if (frame.view.by == CompareBy::difference) return {{place.pixels, {frame.shown, other}, true}};
  constexpr double kFar = 1e9;
  const bool vertical = frame.view.wipe_vertical;
  return {{strip_between(place, vertical, place.border, kFar), {frame.shown, frame.shown}},
          {strip_between(place, vertical, -kFar, place.border), {other, other}}};
}

Push push_of(const ViewFrame& frame, const Place& place, Size shown, Size compared) {
  Push push{};
  push.power[3] = static_cast<float>(1 / frame.view.gamma);
  push.below = color_and(kMarkBelow, std::exp2(frame.view.exposure));
  push.above = color_and(kMarkAbove, 0);
  push.not_finite = color_and(kMarkNotFinite, 0);
  push.origin = {static_cast<float>(place.origin.x), static_cast<float>(place.origin.y)};
  push.scale = static_cast<float>(place.scale);
  push.checker = 12 * frame.pixel_scale;
  push.picture = pair_of(frame.picture);
  push.shown_size = pair_of(shown);
  push.compared_size = pair_of(compared);
  return push;
}

Reads reads_of(const ViewFrame& frame, const Place& place, Size image) {
  const auto reach = [&](int side, int of_picture) { return side / (place.scale * of_picture); };
  const bool minified = reach(image.width, frame.picture.width) > 1 || reach(image.height, frame.picture.height) > 1;
  return minified ? kMean : frame.view.smooth ? kSmooth : kNearest;
}

std::int32_t flags_of(const ViewFrame& frame) {
  return (frame.view.marks == Marks::range ? kFalseColor : 0) | (frame.view.marks == Marks::stops ? kZoned : 0) |
         (frame.view.gamma != 1 ? kGamma : 0) | (frame.background == ViewBackground::gray ? kGray : 0) |
         (frame.background == ViewBackground::checker ? kChecker : 0);
}

/// What the processor can make of it.
std::optional<PlainView> plain_view(const ViewFrame& frame, const Place& place, const Strip& strip, bool by_table) {
  const ViewImage& image = strip.images[0];
  if (!image.pixels || strip.difference || by_table || flags_of(frame) != 0 || frame.view.channel != ViewChannel::color)
    return std::nullopt;
  const Reads reads = reads_of(frame, place, image.size);
  if (reads == kSmooth) return std::nullopt;
  return PlainView{.pixels = image.pixels,
                   .row_pitch = image.row_pitch,
                   .half = image.half,
                   .means = reads == kMean,
                   .size = image.size,
                   .picture = frame.picture,
                   .origin = {static_cast<float>(place.origin.x), static_cast<float>(place.origin.y)},
                   .scale = static_cast<float>(place.scale),
                   .gain = static_cast<float>(std::exp2(frame.view.exposure))};
}

}  // namespace

struct ViewPass::State {
  const Device& device;
  PlainPass plain;
  bool encode = true;
  VkFormat target = VK_FORMAT_UNDEFINED;
  DrawLayout layout, fill_layout;
  ShaderModuleHandle vertex, fragment;
  std::map<Constants, PipelineHandle> pipelines;
  PipelineHandle filling;
  SamplerHandle sampler;
  DescriptorPoolHandle pool;
  ViewTable table;
  std::vector<VkDescriptorSet> sets;  // of each slot, of each frame, kSetsOfFrame in a row
  std::vector<Rect> only;             // pixels that are recorded now
  bool plain_made = false;            // what `plain` can make is in the target

  bool reached(const Rect& pixels) const {
    return std::ranges::any_of(only, [&](const Rect& r) { return common_part(r, pixels).size().area() > 0; });
  }

  Result<void> make_shaders();
  Result<VkPipeline> pipeline(Constants constants);
  Result<void> make_sets(std::size_t count);
  void bind(VkDescriptorSet set, const std::array<ViewImage, kImages>& images) const;
  Result<void> draw(VkCommandBuffer commands, const Rect& pixels, const Constants& constants, const Push& push);
  void draw_parts(VkCommandBuffer commands, const Rect& pixels) const;
  void fill(VkCommandBuffer commands, const Rect& pixels, const ViewColor& color);
  bool by_table(const ViewFrame& frame) const { return table.planes() > 0 && frame.view.as_display; }
  void make_plain(const ViewFrame& frame, std::span<const Rect> parts);
  Result<void> draw_strip(VkCommandBuffer commands, VkDescriptorSet set, const ViewFrame& frame, const Place& place,
                          const Strip& strip);
  Result<void> draw_frame(VkCommandBuffer commands, std::span<const VkDescriptorSet, kSetsOfFrame> own,
                          const ViewFrame& frame);
};

Result<void> ViewPass::State::make_shaders() {
  AFTERGLOW_TRY(layout,
                create_draw_layout(device, {.images = std::vector(kBindings, kImageType), .push_bytes = sizeof(Push)}));
  AFTERGLOW_TRY(vertex, create_shader_module(device, kFullscreenVertex, "view"));
  AFTERGLOW_TRY(fragment, create_shader_module(device, kViewFrag, "view"));
  AFTERGLOW_TRY(fill_layout, create_draw_layout(device, {.push_bytes = sizeof(ViewFill)}));
  AFTERGLOW_TRY(const auto fill, create_shader_module(device, kFillFrag, "fill"));
  AFTERGLOW_TRY(filling, create_draw_pipeline(device, fill_layout, vertex.get(), fill.get(), {target}, "fill"));
  AFTERGLOW_TRY(sampler, create_sampler(device, VK_FILTER_NEAREST));
  return {};
}

/// Made when a way of looking is first used.
Result<VkPipeline> ViewPass::State::pipeline(Constants constants) {
  if (encode) constants[0] |= kEncode;
  PipelineHandle& made = pipelines[constants];
  if (!made) {
    AFTERGLOW_TRY(made,
                  create_draw_pipeline(device, layout, vertex.get(), fragment.get(), {target}, "view", constants));
  }
  return made.get();
}

Result<void> ViewPass::State::make_sets(std::size_t count) {
  const auto number = static_cast<std::uint32_t>(count);
  const VkDescriptorPoolSize size{kImageType, kBindings * number};
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
  std::array<VkDescriptorImageInfo, kBindings> infos{};
  std::array<VkWriteDescriptorSet, kBindings> writes{};
  for (std::uint32_t i = 0; i < kBindings; ++i) {
    const ViewImage& image = images[std::min(i, kImages - 1)];
    infos[i] = {sampler.get(), image.view, image.layout};
    if (i >= kImages && table.planes() > 0)
      infos[i] = {sampler.get(), table.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                 .dstSet = set,
                 .dstBinding = i + 1,
                 .descriptorCount = 1,
                 .descriptorType = kImageType,
                 .pImageInfo = &infos[i]};
  }
  device.vk().vkUpdateDescriptorSets(device.handle(), kBindings, writes.data(), 0, nullptr);
}

/// With the pipeline that is bound.
void ViewPass::State::draw_parts(VkCommandBuffer commands, const Rect& pixels) const {
  for (const Rect& part : only) {
    const Rect at = common_part(part, pixels);
    if (at.size().area() == 0) continue;
    const auto width = static_cast<std::uint32_t>(at.width), height = static_cast<std::uint32_t>(at.height);
    const VkViewport viewport{static_cast<float>(at.x),
                              static_cast<float>(at.y),
                              static_cast<float>(width),
                              static_cast<float>(height),
                              0,
                              1};
    const VkRect2D scissor{{at.x, at.y}, {width, height}};
    device.vk().vkCmdSetViewport(commands, 0, 1, &viewport);
    device.vk().vkCmdSetScissor(commands, 0, 1, &scissor);
    device.vk().vkCmdDraw(commands, 3, 1, 0, 0);
  }
}

/// Of these pixels of the target, with the set that is bound.
Result<void> ViewPass::State::draw(VkCommandBuffer commands, const Rect& pixels, const Constants& constants,
                                   const Push& push) {
  if (!reached(pixels)) return {};
  AFTERGLOW_TRY(const VkPipeline pipeline, this->pipeline(constants));
  device.vk().vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
  device.vk().vkCmdPushConstants(commands, layout.pipeline.get(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push, &push);
  draw_parts(commands, pixels);
  return {};
}

void ViewPass::State::fill(VkCommandBuffer commands, const Rect& pixels, const ViewColor& color) {
  if (!reached(pixels)) return;
  ViewFill push = color_and(color, 1);
  if (encode) std::ranges::copy(color, push.begin());
  device.vk().vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, filling.get());
  device.vk().vkCmdPushConstants(commands, fill_layout.pipeline.get(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push,
                                 push.data());
  draw_parts(commands, pixels);
}

Result<void> ViewPass::State::draw_strip(VkCommandBuffer commands, VkDescriptorSet set, const ViewFrame& frame,
                                         const Place& place, const Strip& strip) {
  if (!reached(strip.pixels) || (plain_made && plain_view(frame, place, strip, by_table(frame)))) return {};
  bind(set, strip.images);
  device.vk().vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout.pipeline.get(), 0, 1, &set, 0,
                                      nullptr);
  const auto& [shown, compared] = strip.images;
  Push push = push_of(frame, place, shown.size, compared.size);
  push.planes = table.planes();
  push.shaper = table.shaper();
  return draw(commands, strip.pixels,
              {flags_of(frame) | (strip.difference ? kDifference : 0) | (by_table(frame) ? kTable : 0),
               static_cast<std::int32_t>(frame.view.channel), reads_of(frame, place, shown.size),
               strip.difference ? reads_of(frame, place, compared.size) : kNearest},
              push);
}

Result<void> ViewPass::State::draw_frame(VkCommandBuffer commands, std::span<const VkDescriptorSet, kSetsOfFrame> own,
                                         const ViewFrame& frame) {
  const Place place = place_of(frame);
  const std::vector<Strip> strips = strips_of(frame, place);
  for (std::size_t i = 0; i < strips.size(); ++i)
    AFTERGLOW_CHECK(draw_strip(commands, own[i], frame, place, strips[i]));
  for (const Rect& beside : parts_beside(frame.area, place.pixels)) fill(commands, beside, frame.outside);
  if (strips.size() < 2) return {};
  // A bright line between dark ones shows on any picture.
  const double half_width = frame.pixel_scale;
  for (const auto& [half, color] : {std::pair(half_width + 1, kBesideBorder), std::pair(half_width, kBorder)})
    fill(commands, strip_between(place, frame.view.wipe_vertical, place.border - half, place.border + half), color);
  return {};
}

void ViewPass::State::make_plain(const ViewFrame& frame, std::span<const Rect> parts) {
  const Place place = place_of(frame);
  for (const Strip& strip : strips_of(frame, place)) {
    auto view = plain_view(frame, place, strip, by_table(frame));
    if (!view) continue;
    view->blue_first = plain.blue_first();
    for (const Rect& part : parts) plain.add(*view, common_part(part, strip.pixels));
  }
}

Result<std::unique_ptr<ViewPass>> ViewPass::create(const Device& device, VkFormat target, std::size_t slots) {
  std::unique_ptr<State> state(new State{.device = device, .plain = PlainPass(device, target, slots)});
  state->encode = !encodes_srgb(target);
  state->target = target;
  AFTERGLOW_CHECK(state->make_shaders());
  AFTERGLOW_CHECK(state->make_sets(slots * kMostFrames * kSetsOfFrame));
  return std::unique_ptr<ViewPass>(new ViewPass(std::move(state)));
}

Result<void> ViewPass::take_table(const DisplayTable& table) { return state_->table.take(state_->device, table); }

Result<bool> ViewPass::prepare(VkCommandBuffer commands, std::size_t slot, VkImage target,
                               std::span<const ViewFrame> frames, std::span<const Rect> only) {
  State& s = *state_;
  s.table.upload(s.device, commands);
  s.plain_made = target != VK_NULL_HANDLE && s.plain.works();
  if (!s.plain_made) return false;
  s.plain.begin(slot);
  for (const ViewFrame& frame : frames.first(std::min(frames.size(), kMostFrames))) s.make_plain(frame, only);
  return s.plain.record(commands, target);
}

ViewPass::ViewPass(std::unique_ptr<State> state) : state_(std::move(state)) {}
ViewPass::~ViewPass() = default;

Rect picture_pixels(const ViewFrame& frame) { return place_of(frame).pixels; }

Result<void> ViewPass::record(VkCommandBuffer commands, std::size_t slot, std::span<const ViewFrame> frames,
                              std::span<const Rect> only, const ViewColor& background) {
  State& s = *state_;
  s.device.begin_label(commands, "view");
  s.only.assign(only.begin(), only.end());
  std::vector<Rect> beside(only.begin(), only.end());  // all frames: their pixels may be there already
  for (const ViewFrame& frame : frames) {
    std::vector<Rect> rest;
    for (const Rect& part : beside)
      for (const Rect& r : parts_beside(part, common_part(part, frame.area)))
        if (r.size().area() > 0) rest.push_back(r);
    beside = std::move(rest);
  }
  for (const Rect& part : beside) s.fill(commands, part, background);
  for (std::size_t i = 0; i < std::min(frames.size(), kMostFrames); ++i)
    if (s.reached(frames[i].area)) {
      const VkDescriptorSet* sets = &s.sets[(slot * kMostFrames + i) * kSetsOfFrame];
      AFTERGLOW_CHECK(
          s.draw_frame(commands, std::span<const VkDescriptorSet, kSetsOfFrame>(sets, kSetsOfFrame), frames[i]));
    }
  s.device.end_label(commands);
  return {};
}

}  // namespace afterglow
