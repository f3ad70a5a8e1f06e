#include "bench/oracle.h"

#include <algorithm>

namespace afterglow::bench {
namespace {

reference::DoubleImage as_double(const Image& image) {
  return reference::from_floats(image.pixels.data(), image.size(), image.channels);
}

}  // namespace

std::vector<reference::Entry> oracle_entries(const Build& build) {
  std::vector<reference::Entry> out;
  for (const auto& entry : *build.entries) {
    if (!entry.enabled ||
        std::ranges::find(build.graph.skipped, entry.name, &Skipped::name) != build.graph.skipped.end())
      continue;
    reference::Entry one{.effect = entry.effect, .settings = {}};
    for (const auto& [name, value] : entry.settings) one.settings[name] = {value.number, value.choice};
    out.push_back(std::move(one));
  }
  return out;
}

std::vector<double> oracle_result(const Picture& picture, const std::vector<reference::Entry>& entries) {
  std::map<std::string, reference::DoubleImage> auxiliary;
  for (const auto& [name, image] : picture.auxiliary) auxiliary[name] = as_double(image);
  const auto find = [&](const char* name) {
    const auto found = auxiliary.find(name);
    return found == auxiliary.end() ? nullptr : &found->second;
  };
  const auto result = reference::evaluate(
      as_double(picture.color), {.depth = find("depth"), .normal = find("normal"), .motion = find("motion")}, entries);
  std::vector<double> rgb;
  rgb.reserve(result.pixels.size() * 3);
  for (const auto& p : result.pixels) rgb.insert(rgb.end(), {p.r, p.g, p.b});
  return rgb;
}

}  // namespace afterglow::bench
