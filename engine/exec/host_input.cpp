// SPDX-License-Identifier: MIT
#include "exec/host_input.h"

#include <fmt/format.h>

#include "exec/convert.h"
#include "gpu/image.h"

namespace afterglow {

namespace {

Error input_error(const std::string& message) { return Error{ErrorKind::other, message}; }

}  // namespace

Result<void> check_input(const Graph& graph, const std::string& name, ImageId id,
                         const std::map<std::string, HostImage>& inputs) {
  const auto found = inputs.find(name);
  if (found == inputs.end() || (!found->second.pixels && !found->second.read_row))
    return input_error(fmt::format("the frame has no image '{}'", name));
  const Size size = found->second.size, wanted = graph.images[id].size;
  if (size != wanted) {
    return input_error(fmt::format("image '{}' has {}×{} pixels, the stack was built for {}×{}", name, size.width,
                                   size.height, wanted.width, wanted.height));
  }
  if (found->second.channels < 1 || found->second.channels > 4) {
    return input_error(fmt::format("image '{}' has {} channels; 1 to 4 are possible", name, found->second.channels));
  }
  return {};
}

std::map<std::string, ImageId> inputs_of(const Graph& graph) {
  std::map<std::string, ImageId> out = graph.auxiliary;
  out["source"] = graph.source;
  return out;
}

std::map<std::string, HostImage> usual_inputs(const Graph& graph) {
  static const float kNothing = 0;
  std::map<std::string, HostImage> out;
  for (const auto& [name, id] : inputs_of(graph))
    out[name] = {.pixels = &kNothing,
                 .size = graph.images[id].size,
                 .channels = known_channels(name).value_or(name == "source" ? 4 : 3)};
  return out;
}

VkFormat input_format(const std::string& name, int channels, VkFormat storage) {
  if (name == "source") return storage;
  return known_channels(name).value_or(channels) == 1 ? VK_FORMAT_R32_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
}

void copy_source(const HostImage& source, HostResult& out) {
  out.unorm8.clear();
  std::vector<float>& pixels = out.pixels;
  const auto [width, height] = source.size;
  if (source.read_row && out.write_row) {
    constexpr VkFormat kFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
    std::vector<float> row(static_cast<std::size_t>(width) * static_cast<std::size_t>(source.channels));
    std::vector<std::byte> packed(static_cast<std::size_t>(width) * bytes_per_pixel(kFormat));
    for (int y = 0; y < height; ++y) {
      source.read_row(y, row.data());
      pack_row(row.data(), source.channels, width, kFormat, packed.data());
      out.clamped += out.write_row(0, y, width, kFormat, packed.data());
    }
    return;
  }
  if (source.pixels == pixels.data() && source.channels == 4) return;
  std::vector<float> copy(static_cast<std::size_t>(source.size.area()) * 4);
  for (int y = 0; y < height; ++y) {
    const auto first = static_cast<std::ptrdiff_t>(y) * width;
    pack_row(source.pixels + first * source.channels, source.channels, width, VK_FORMAT_R32G32B32A32_SFLOAT,
             reinterpret_cast<std::byte*>(copy.data() + first * 4));
  }
  pixels = std::move(copy);
}

}  // namespace afterglow
