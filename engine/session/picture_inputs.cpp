// SPDX-License-Identifier: MIT
#include "session/picture_inputs.h"

#include <fmt/format.h>

#include "core/half.h"
#include "image/metadata.h"

namespace afterglow {
namespace {

HostImage host_image(const Picture& picture, const std::string& name, const Image& image) {
  HostImage out{image.pixels.data(), image.size(), image.channels};
  if (name == "source" && !picture.halves.empty())
    out.read_row = [halves = picture.halves.data(), values = static_cast<std::size_t>(image.width) * 4](
                       int y, float* row) { from_half(halves + values * static_cast<std::size_t>(y), row, values); };
  if (const auto known = picture.content.find(name); known != picture.content.end()) out.content = known->second;
  return out;
}

}  // namespace

std::map<std::string, HostImage> picture_inputs(const Picture& picture, const Graph& graph) {
  std::map<std::string, HostImage> inputs{{"source", host_image(picture, "source", picture.color)}};
  for (const auto& [name, id] : graph.auxiliary) inputs[name] = host_image(picture, name, picture.auxiliary.at(name));
  return inputs;
}

BuildContext context_of(const Picture& picture, const BuildContext& frame) {
  BuildContext context = frame;
  context.size = picture.color.size();
  context.auxiliary.clear();
  context.layers = picture.layers;
  if (picture.facts) context.metadata = {picture.facts, &picture.facts->metadata};
  for (const auto& [name, image] : picture.auxiliary) context.auxiliary[name] = image.size();
  return context;
}

}  // namespace afterglow
