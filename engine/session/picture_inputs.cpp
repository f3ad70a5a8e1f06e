// SPDX-License-Identifier: MIT
#include "session/picture_inputs.h"

#include <fmt/format.h>

#include <bit>

#include "core/half.h"
#include "core/printable.h"
#include "image/metadata.h"

namespace afterglow {
namespace {

HostImage host_image(const Picture& picture, const std::string& name, const Image& image) {
  HostImage out{image.pixels.data(), image.size(), image.channels};
  if (name == "source" && !picture.halves.empty())
    out.read_row = [halves = picture.halves.data(), values = static_cast<std::size_t>(image.width) * 4](int y,
                                                                                                        float* row) {
      floats_from_halves(halves + values * static_cast<std::size_t>(y), values, row);
    };
  if (const auto known = picture.content.find(name); known != picture.content.end()) out.content = known->second;
  return out;
}

}  // namespace

std::map<std::string, HostImage> picture_inputs(const Picture& picture, const Graph& graph) {
  std::map<std::string, HostImage> inputs{{"source", host_image(picture, "source", picture.color)}};
  for (const auto& [name, id] : graph.auxiliary) inputs[name] = host_image(picture, name, picture.auxiliary.at(name));
  return inputs;
}

void warn_if_absent(const CryptomatteObject& object, const Picture& picture, Diagnostics& diagnostics) {
  bool looked = false;
  for (const char* ranks : {"00", "01", "02"}) {
    const auto found = picture.auxiliary.find("layer:" + object.layer + ranks);
    if (found == picture.auxiliary.end() || found->second.channels != 4) continue;
    looked = true;
    const std::vector<float>& pixels = found->second.pixels;  // two ranks of (id, coverage)
    for (std::size_t i = 0; i < pixels.size(); i += 2)
      if (std::bit_cast<std::uint32_t>(pixels[i]) == object.id) return;
  }
  if (looked)
    diagnostics.warn_once("cryptomatte " + object.layer + " " + object.name,
                          fmt::format("the cryptomatte '{}' has no manifest, and no pixel has the id of the name '{}': "
                                      "it selects nothing",
                                      object.layer, tidy_message(object.name, 100)));
}

void note_files(const std::shared_ptr<const FileFacts>& facts, BuildContext& context) {
  if (!facts) return;
  context.metadata = {facts, &facts->metadata};
  context.picture = facts->file;
  if (facts->mattes.empty()) return;
  context.matte_metadata = {facts, &facts->matte_metadata};
  context.mattes = facts->mattes;
}

BuildContext context_of(const Picture& picture, const BuildContext& frame) {
  BuildContext context = frame;
  context.size = picture.color.size();
  context.auxiliary.clear();
  context.asked = picture.asked;
  context.layers = picture.layers;
  context.hints = picture.hints;
  note_files(picture.facts, context);
  for (const auto& [name, image] : picture.auxiliary) context.auxiliary[name] = image.size();
  return context;
}

}  // namespace afterglow
