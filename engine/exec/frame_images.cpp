// SPDX-License-Identifier: MIT
#include "exec/frame_images.h"

#include <fmt/format.h>

#include "core/memory_limit.h"
#include "core/stopwatch.h"
#include "core/text.h"
#include "exec/host_input.h"

namespace afterglow {
namespace {

std::uint64_t image_bytes(const ImageDesc& desc) {
  return static_cast<std::uint64_t>(desc.size.area()) * bytes_per_pixel(desc.format);
}

DeviceImage device_image(const FrameImage& from) {
  DeviceImage out{.binding = binding_of(from), .layout = from.layout};
  if (!from.direct) return out;
  out.pixels = from.image.row(0);
  out.row_pitch = from.image.row_pitch();
  return out;
}

}  // namespace

FrameImages::FrameImages(Device& device, const Options& options)
    : inputs(device, options.direct),
      result(device, options.direct),
      staging(device, options.whole_staging),
      options_(options) {}

Result<void> FrameImages::check_memory(const std::map<std::string, ImageDesc>& descs, std::uint64_t other_bytes) const {
  std::uint64_t total = other_bytes;
  for (const auto& [name, desc] : descs) total += image_bytes(desc);
  if (total <= options_.max_memory) return {};
  return Error{ErrorKind::io, fmt::format("the frame needs {} of device memory, more than the {}", needed_memory(total),
                                          allowed_memory(options_.max_memory))};
}

Result<void> FrameImages::prepare(const Program& program, const std::map<std::string, HostImage>& host) {
  AFTERGLOW_TRY(const auto descs, FrameInputs::wanted_by(program, host));
  const ImageDesc result_desc = FrameResult::wanted_by(program);
  std::uint64_t bytes = program.memory().arena + program.memory().histories + image_bytes(result_desc);
  if (!options_.direct) bytes += 2 * staging.bytes({VK_NULL_HANDLE, result_desc.format, result_desc.size});
  AFTERGLOW_CHECK(check_memory(descs, bytes));
  AFTERGLOW_CHECK(inputs.prepare(descs));
  return take_result(program);
}

Result<void> FrameImages::take_result(const Program& program) {
  return result.take(FrameResult::wanted_by(program), program.result_rows());
}

Result<void> FrameImages::upload(const Program& program, const std::map<std::string, HostImage>& host, bool look) {
  const bool half = program.storage_format() == VK_FORMAT_R16G16B16A16_SFLOAT;
  staging.begin_uploads();
  for (const auto& [name, id] : inputs_of(program.graph()))
    AFTERGLOW_CHECK(inputs.upload(staging, name, host.at(name), program.parts().images[id], look && name == "source",
                                  half ? Storage::fp16 : Storage::fp32));
  return {};
}

Result<double> FrameImages::bring_source(const std::map<std::string, HostImage>& host) {
  const auto source = host.find("source");
  if (source == host.end() || !source->second.pixels) return Error{ErrorKind::other, "the frame has no image 'source'"};
  const HostImage& given = source->second;
  const std::map<std::string, ImageDesc> descs{{"source",
                                                {.name = "source",
                                                 .size = given.size,
                                                 .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                                 .usage = VK_IMAGE_USAGE_SAMPLED_BIT}}};
  AFTERGLOW_CHECK(check_memory(descs, 0));
  AFTERGLOW_CHECK(inputs.prepare(descs));
  const auto start = Clock::now();
  const Rect all{0, 0, given.size.width, given.size.height};
  staging.begin_uploads();
  AFTERGLOW_CHECK(inputs.upload(staging, "source", given, all, false, Storage::fp32));
  return milliseconds_since(start);
}

FrameImages::Handles FrameImages::handles() const {
  Handles out{result.images(), made()};
  for (const auto& [name, image] : inputs.images()) out.images.push_back(image.image.get());
  return out;
}

DeviceImages FrameImages::on_device(bool ran) const {
  DeviceImages out;
  if (const auto source = inputs.images().find("source"); source != inputs.images().end())
    out.source = device_image(source->second);
  out.ran = ran;
  out.result = ran ? device_image(result.image()) : out.source;
  return out;
}

}  // namespace afterglow
