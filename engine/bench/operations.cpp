// SPDX-License-Identifier: MIT
#include "bench/operations.h"

#include <fmt/format.h>

#include <memory>

#include "exec/timing.h"
#include "gpu/image.h"

namespace afterglow::bench {
namespace {

constexpr VkFormat kFloats = VK_FORMAT_R32G32B32A32_SFLOAT;

struct NamedFormat {
  const char* name;
  VkFormat format;
};
constexpr NamedFormat kFormats[] = {{"RGBA32F", kFloats},
                                    {"RGBA16F", VK_FORMAT_R16G16B16A16_SFLOAT},
                                    {"R11G11B10F", VK_FORMAT_B10G11R11_UFLOAT_PACK32},
                                    {"RGBA8", VK_FORMAT_R8G8B8A8_UNORM}};

/// Two images of a format, the first with the picture in it, and the copy of it to the second.
struct FormatCopy {
  GpuImage from, to;
  KernelWork copy;
};

ImageBinding binding(const GpuImage& image) {
  return {image.get(), image.view(), image.desc().format, image.desc().size};
}

Result<std::unique_ptr<FormatCopy>> make_copy(const Device& device, KernelCompiler& compiler,
                                              const ImageBinding& source, const NamedFormat& format) {
  auto out = std::make_unique<FormatCopy>();
  const ImageDesc desc{.name = format.name,
                       .size = source.size,
                       .format = format.format,
                       .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT};
  AFTERGLOW_TRY(out->from, GpuImage::create(device, desc));
  AFTERGLOW_TRY(out->to, GpuImage::create(device, desc));
  AFTERGLOW_TRY(KernelWork fill, KernelWork::create(device, compiler, {}, source, binding(out->from), "fill"));
  AFTERGLOW_TRY(const double ignored, fill.work().run());
  (void)ignored;
  AFTERGLOW_TRY(TimedWork leave, TimedWork::create(device, [&](VkCommandBuffer commands) {
                  const auto readable =
                      image_barrier(out->from.get(), VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                    VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                    VK_IMAGE_LAYOUT_GENERAL);
                  record_barriers(device, commands, &readable, 1);
                }));
  AFTERGLOW_CHECK(leave.run());
  AFTERGLOW_TRY(out->copy, KernelWork::create(device, compiler, {}, binding(out->from), binding(out->to), format.name));
  return out;
}

/// A bilinear shift by a third of a texel: one filtered fetch, or four integer fetches.
KernelDesc shift(bool hardware_filter) {
  KernelDesc kernel;
  kernel.filter = Filter{.interpolation = Interpolation::linear, .x = {{0.3, 1}}, .y = {{0.3, 1}}, .taps = {}};
  kernel.ratio_x = kernel.ratio_y = AxisRatio::same;
  kernel.config.hardware_filter = hardware_filter;
  return kernel;
}

}  // namespace

Result<std::vector<OperationCost>> measure_operations(Device& device, const StackOptions& base, const Picture& picture,
                                                      int repeat, const Step& step) {
  KernelCompiler compiler(base.cache_folder.empty() ? "" : base.cache_folder / "shaders");
  AFTERGLOW_TRY(const DevicePicture floats, DevicePicture::create(device, picture, {}));
  std::vector<std::string> names;
  std::vector<Measured> all;
  std::vector<std::unique_ptr<FormatCopy>> copies;
  for (const auto& format : kFormats) {
    if (!supports(device, format.format, kDrawnAndSampled)) continue;
    AFTERGLOW_TRY(auto copy, make_copy(device, compiler, floats.source(), format));
    names.push_back(fmt::format("copy {}", format.name));
    all.emplace_back([work = &copy->copy.work()] { return work->run(); });
    copies.push_back(std::move(copy));
  }
  const std::pair<const char*, KernelDesc> kKernels[] = {
      {"storage read RGBA32F", {.reads = {ImageRead::storage_rgba32f}}},
      {"filtered fetch RGBA32F", shift(true)},
      {"the same by integer fetches", shift(false)},
  };
  std::vector<std::unique_ptr<KernelWork>> kernels;
  for (const auto& [name, kernel] : kKernels) {
    AFTERGLOW_TRY(auto work, KernelWork::create(device, compiler, kernel, floats.source(), floats.result(), name));
    names.emplace_back(name);
    kernels.push_back(std::make_unique<KernelWork>(std::move(work)));
    all.emplace_back([made = kernels.back().get()] { return made->work().run(); });
  }
  AFTERGLOW_TRY(ComputeCopy compute, ComputeCopy::create(device, floats.source()));
  names.emplace_back("compute copy RGBA32F");
  all.emplace_back([&] { return compute.work().run(); });

  AFTERGLOW_TRY(const auto spreads, run_in_turns(all, repeat, [&](int round) {
                  return step(fmt::format("operations: round {} of {}", round, repeat));
                }));
  std::vector<OperationCost> out;
  for (std::size_t i = 0; i < names.size(); ++i)
    out.push_back({names[i], spreads[i].median * 1e6 / static_cast<double>(picture.color.size().area())});
  return out;
}

}  // namespace afterglow::bench
