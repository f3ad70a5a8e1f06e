// SPDX-License-Identifier: MIT
#include "exec/frame_inputs.h"

#include <algorithm>
#include <atomic>

#include "exec/barriers.h"
#include "exec/brightest.h"
#include "exec/convert.h"
#include "exec/host_input.h"

namespace afterglow {
namespace {

/// The rows of `part`; the others hold anything. `brightest`: what to note pixels in while they are at hand, or null.
Result<std::uint64_t> write_pixels(Staging& staging, FrameImage& image, const HostImage& host, const Rect& part,
                                   Brightest* brightest) {
  const ImageDesc& desc = image.image.desc();
  const auto width = static_cast<std::ptrdiff_t>(desc.size.width);
  // Rows that are made for this may be made in the image itself, where the CPU can read it as fast as its own memory.
  const bool in_place = image.direct && host.channels == 4 && desc.format == VK_FORMAT_R32G32B32A32_SFLOAT;
  const auto pack = [&](int y, std::byte* to) -> std::uint64_t {
    if (y < part.y || y >= part.y + part.height) return 0;
    if (host.read_row && in_place) {
      auto* row = reinterpret_cast<float*>(to);
      host.read_row(y, row);
      if (brightest) brightest->add_row(row, host.channels, desc.size.width);
      return 0;
    }
    thread_local std::vector<float> made;
    const float* row = host.pixels + static_cast<std::ptrdiff_t>(y) * width * host.channels;
    if (host.read_row) {
      made.resize(static_cast<std::size_t>(width * host.channels));
      host.read_row(y, made.data());
      row = made.data();
    }
    if (brightest) brightest->add_row(row, host.channels, desc.size.width);
    return pack_row(row, host.channels, desc.size.width, desc.format, to);
  };
  if (!image.direct) {
    image.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    return staging.upload(staged(image), pack);
  }
  const auto clamped = over_rows(part.height, image.image.row_pitch(),
                                 [&](int y) { return pack(part.y + y, image.image.row(part.y + y)); });
  AFTERGLOW_CHECK(image.image.memory().flush());
  return clamped;
}

/// Programs of several runners may share images, and what these hold is told by the versions of what they read.
std::uint64_t next_version() {
  static std::atomic<std::uint64_t> versions = 0;
  return ++versions;
}

}  // namespace

Result<std::map<std::string, ImageDesc>> FrameInputs::wanted_by(const Program& program,
                                                                const std::map<std::string, HostImage>& host) {
  const Graph& graph = program.graph();
  std::map<std::string, ImageDesc> descs;
  for (const auto& [name, id] : inputs_of(graph)) {
    AFTERGLOW_CHECK(check_input(graph, name, id, host));
    descs[name] = {.name = name,
                   .size = graph.images[id].size,
                   .format = input_format(name, host.at(name).channels, program.storage_format()),
                   .usage = VK_IMAGE_USAGE_SAMPLED_BIT};
    if (program.input_layout() == VK_IMAGE_LAYOUT_GENERAL) descs[name].usage |= VK_IMAGE_USAGE_STORAGE_BIT;
  }
  return descs;
}

Result<void> FrameInputs::prepare(const std::map<std::string, ImageDesc>& wanted) {
  std::erase_if(images_, [&](const auto& entry) { return !wanted.contains(entry.first); });
  std::erase_if(held_, [&](const auto& entry) { return !wanted.contains(entry.first); });
  for (const auto& [name, desc] : wanted) {
    FrameImage& image = images_[name];
    if (image.fits(desc)) continue;
    held_.erase(name);
    image = {};  // before the new one is made: the two need not exist at once
    AFTERGLOW_TRY(image, FrameImage::create(*device_, desc, direct_ ? HostAccess::write : HostAccess::none));
    ++made_;
  }
  return {};
}

Result<void> FrameInputs::upload(Staging& staging, const std::string& name, const HostImage& given, const Rect& part,
                                 bool look, Storage storage) {
  Held& known = held_[name];
  const bool same = given.content && known.content == given.content && known.part == part;
  if (same && (!look || known.found)) return {};
  Brightest brightest;
  known = {.content = {}, .part = part, .version = next_version(), .clamped = 0, .found = {}};
  AFTERGLOW_TRY(known.clamped, write_pixels(staging, images_.at(name), given, part, look ? &brightest : nullptr));
  known.content = given.content;
  if (look) known.found = SourceContent{brightest.value(storage), brightest.opaque()};
  return {};
}

std::vector<VkImageLayout> FrameInputs::layouts() const {
  std::vector<VkImageLayout> out;
  for (const auto& [name, image] : images_) out.push_back(image.layout);
  return out;
}

void FrameInputs::set_layouts(const std::vector<VkImageLayout>& layouts) {
  auto layout = layouts.begin();
  for (auto& [name, image] : images_) image.layout = *layout++;
}

Program::InputVersions FrameInputs::versions() const {
  Program::InputVersions out;
  for (const auto& [name, held] : held_) out[name] = held.version;
  return out;
}

std::uint64_t FrameInputs::clamped() const {
  std::uint64_t sum = 0;
  for (const auto& [name, held] : held_) sum += held.clamped;
  return sum;
}

std::map<std::string, ImageBinding> FrameInputs::bindings() const {
  std::map<std::string, ImageBinding> out;
  for (const auto& [name, image] : images_) out[name] = binding_of(image);
  return out;
}

void FrameInputs::before(const Program& program, VkCommandBuffer commands) {
  std::vector<VkImageMemoryBarrier2> barriers;
  const VkImageLayout wanted = program.input_layout();
  for (auto& [name, image] : images_) {
    if (!image.direct && image.layout == wanted) continue;  // the upload has done it
    const VkPipelineStageFlags2 stage =
        VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | (image.direct ? VK_PIPELINE_STAGE_2_HOST_BIT : 0);
    const VkAccessFlags2 access = image.direct ? VK_ACCESS_2_HOST_WRITE_BIT : VK_ACCESS_2_NONE;
    barriers.push_back(image_barrier(image.image.get(), stage, access, image.layout,
                                     VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, reading_access(wanted), wanted));
    image.layout = wanted;
  }
  record_barriers(*device_, commands, barriers.data(), barriers.size());
}

void FrameInputs::after(VkCommandBuffer commands) {
  std::vector<VkImageMemoryBarrier2> barriers;
  for (auto& [name, image] : images_) {
    const VkImageLayout to = image.direct ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    if (!image.direct && image.layout == to) continue;
    const bool fresh = image.layout == VK_IMAGE_LAYOUT_PREINITIALIZED;
    barriers.push_back(image_barrier(
        image.image.get(), VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | (fresh ? VK_PIPELINE_STAGE_2_HOST_BIT : 0),
        fresh ? VK_ACCESS_2_HOST_WRITE_BIT : VK_ACCESS_2_NONE, image.layout, shown_stage(image),
        shown_access(image, VK_ACCESS_2_HOST_WRITE_BIT), to));
    image.layout = to;
  }
  record_barriers(*device_, commands, barriers.data(), barriers.size());
}

bool FrameInputs::readable() const {
  return std::ranges::none_of(images_,
                              [](const auto& entry) { return entry.second.layout == VK_IMAGE_LAYOUT_PREINITIALIZED; });
}

}  // namespace afterglow
