// Records a preset into this program's own command buffer, between two of its own images, twice in one submission's
// worth of frames, and compares the pixels with what Session makes of the same picture. Exit 0: equal and validation
// clean.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "afterglow.h"
#include "vulkan_host.h"

namespace {

constexpr int kWidth = 320, kHeight = 180;

std::vector<float> test_picture() {
  std::vector<float> pixels(static_cast<std::size_t>(kWidth) * kHeight * 4);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      float* p = &pixels[(static_cast<std::size_t>(y) * kWidth + x) * 4];
      const float ring = std::exp(-std::pow((std::hypot(x - 160.f, y - 90.f) - 60.f) / 3.f, 2.f));
      p[0] = 0.05f + 20 * ring;
      p[1] = 0.04f + 3 * ring;
      p[2] = 0.1f + 8 * ring;
      p[3] = 1;
    }
  return pixels;
}

template <class T>
T must(afterglow::Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text());
  if constexpr (!std::is_void_v<T>) return std::move(result).value();
}

void copy(VkCommandBuffer commands, VkBuffer buffer, VkImage image, bool to_image) {
  VkBufferImageCopy region{};
  region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.imageExtent = {kWidth, kHeight, 1};
  if (to_image)
    vkCmdCopyBufferToImage(commands, buffer, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
  else
    vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &region);
}

std::vector<float> run_embedded(VulkanHost& host, const char* preset, const std::vector<float>& picture) {
  afterglow::Diagnostics diagnostics;
  const auto device =
      must(afterglow::Device::adopt({host.instance, host.physical, host.device, host.queue, host.family}, diagnostics));
  afterglow::StackOptions options;
  options.precision = afterglow::Precision::fp32;
  const auto stack = must(afterglow::Stack::load(preset, options, diagnostics));
  stack->use(*device);
  must(stack->prepare({.size = {kWidth, kHeight}, .auxiliary = {}}));

  HostImageVk source = host.make_image(kWidth, kHeight, VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
  HostImageVk result =
      host.make_image(kWidth, kHeight, VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
  VkDeviceMemory memory;
  float* mapped;
  const VkBuffer buffer = host.make_buffer(picture.size() * sizeof(float), memory, &mapped);
  const afterglow::Size size{kWidth, kHeight};
  must(stack->bind({{"source", {source.image, source.view, VK_FORMAT_R32G32B32A32_SFLOAT, size}}},
                   {result.image, result.view, VK_FORMAT_R32G32B32A32_SFLOAT, size}));

  // Two frames: the second must not be disturbed by what the first left behind.
  for (int frame = 0; frame < 2; ++frame) {
    std::memcpy(mapped, picture.data(), picture.size() * sizeof(float));
    const VkCommandBuffer commands = host.begin();
    VulkanHost::barrier(commands, source.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                        VK_PIPELINE_STAGE_2_NONE, 0, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    copy(commands, buffer, source.image, true);
    VulkanHost::barrier(commands, source.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_2_COPY_BIT,
                        VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                        VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
    VulkanHost::barrier(commands, result.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                        VK_PIPELINE_STAGE_2_NONE, 0, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                        VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
    stack->record(commands);
    VulkanHost::barrier(commands, result.image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                        VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                        VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_PIPELINE_STAGE_2_COPY_BIT,
                        VK_ACCESS_2_TRANSFER_READ_BIT);
    // The buffer was read by the first copy and is written by the second.
    const VkMemoryBarrier2 copied{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr,
                                  VK_PIPELINE_STAGE_2_COPY_BIT,       VK_ACCESS_2_TRANSFER_READ_BIT,
                                  VK_PIPELINE_STAGE_2_COPY_BIT,       VK_ACCESS_2_TRANSFER_WRITE_BIT};
    VulkanHost::barrier(commands, copied);
    copy(commands, buffer, result.image, false);
    VulkanHost::barrier(commands,
                        {VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, VK_PIPELINE_STAGE_2_COPY_BIT,
                         VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
    host.submit_and_wait(commands);
  }
  std::vector<float> out(mapped, mapped + picture.size());
  vkDestroyBuffer(host.device, buffer, nullptr);
  vkFreeMemory(host.device, memory, nullptr);
  host.destroy(source);
  host.destroy(result);
  return out;
}

std::vector<float> run_session(const char* preset, const std::vector<float>& pixels) {
  afterglow::Diagnostics diagnostics;
  afterglow::SessionOptions options;
  options.stack.precision = afterglow::Precision::fp32;
  const auto session = must(afterglow::Session::open(preset, options, diagnostics));
  afterglow::Picture picture;
  picture.color = afterglow::Image(kWidth, kHeight, 4);
  picture.color.pixels = pixels;
  must(session->process(picture));
  return picture.color.pixels;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) throw std::runtime_error("usage: embed PRESET");
  const std::vector<float> picture = test_picture();
  std::vector<float> embedded;
  int validation_errors = 0;
  {
    VulkanHost host;
    embedded = run_embedded(host, argv[1], picture);
    validation_errors = host.validation_errors;
  }
  const std::vector<float> expected = run_session(argv[1], picture);
  double worst = 0, change = 0;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    if (i % 4 == 3) continue;
    worst = std::max(worst, std::abs(double(embedded[i]) - expected[i]) / (std::abs(double(expected[i])) + 0.01));
    change = std::max(change, std::abs(double(embedded[i]) - picture[i]));
  }
  std::printf(
      "embedded against session: worst relative error %.3g; the preset changed the picture by up to %.3g; validation "
      "errors: %d\n",
      worst, change, validation_errors);
  return worst <= 1e-6 && change > 0.01 && validation_errors == 0 ? 0 : 1;
} catch (const std::exception& failure) {
  std::fprintf(stderr, "embed: %s\n", failure.what());
  return 1;
}
