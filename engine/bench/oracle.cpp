// SPDX-License-Identifier: MIT
#include "bench/oracle.h"

#include <algorithm>

#include "script/preset.h"

namespace afterglow::bench {
namespace {

reference::DoubleImage as_double(const Image& image) {
  return reference::from_floats(image.pixels.data(), image.size(), image.channels);
}

}  // namespace

namespace {

std::map<std::string, reference::Value> values_of(const std::vector<std::pair<std::string, SettingValue>>& settings) {
  std::map<std::string, reference::Value> out;
  for (const auto& [name, value] : settings) out[name] = {value.number, value.choice};
  return out;
}

std::shared_ptr<const reference::Mask> mask_of(const EntryMask* mask) {
  if (!mask) return nullptr;
  auto out = std::make_shared<reference::Mask>();
  out->kind = static_cast<reference::Mask::Kind>(mask->kind);
  out->number = mask->number;
  out->name = mask->name;
  out->settings = values_of(mask->settings);
  out->a = mask_of(mask->a.get());
  out->b = mask_of(mask->b.get());
  return out;
}

/// Those from `begin` to `end` that run, with their members counted anew.
void add_entries(const std::vector<StackEntry>& entries, std::size_t begin, std::size_t end, const Graph& graph,
                 std::vector<reference::Entry>& out) {
  for (std::size_t i = begin; i < end;) {
    const StackEntry& entry = entries[i];
    const std::size_t first = entry.first_of(i), middle = entry.middle_of(i), last = entry.end_of(i);
    i = last;
    if (!entry.enabled || std::ranges::find(graph.skipped, entry.name, &Skipped::name) != graph.skipped.end()) continue;
    const std::size_t at = out.size();
    out.push_back({.effect = entry.effect,
                   .settings = values_of(entry.settings),
                   .opacity = entry.opacity,
                   .blend = entry.blend,
                   .mask = mask_of(entry.mask.get())});
    add_entries(entries, first, middle, graph, out);
    out[at].middle = static_cast<int>(out.size() - at) - 1;
    add_entries(entries, middle, last, graph, out);
    out[at].members = static_cast<int>(out.size() - at) - 1;
  }
}

}  // namespace

std::vector<reference::Entry> oracle_entries(const Build& build) {
  std::vector<reference::Entry> out;
  add_entries(*build.entries, 0, build.entries->size(), build.graph, out);
  return out;
}

std::vector<double> oracle_result(const Picture& picture, const std::vector<reference::Entry>& entries, double frame) {
  std::map<std::string, reference::DoubleImage> auxiliary;
  for (const auto& [name, image] : picture.auxiliary) auxiliary[name] = as_double(image);
  const auto find = [&](const char* name) {
    const auto found = auxiliary.find(name);
    return found == auxiliary.end() ? nullptr : &found->second;
  };
  reference::Inputs inputs{.depth = find("depth"), .normal = find("normal"), .motion = find("motion")};
  for (const auto& [name, image] : auxiliary)
    if (name.starts_with("layer:")) inputs.layers[name.substr(6)] = &image;
  inputs.frame = frame;
  inputs.time = (frame - 1) / BuildContext{}.fps;
  const auto result = reference::evaluate(as_double(picture.color), inputs, entries);
  std::vector<double> rgb;
  rgb.reserve(result.pixels.size() * 3);
  for (const auto& p : result.pixels) rgb.insert(rgb.end(), {p.r, p.g, p.b});
  return rgb;
}

}  // namespace afterglow::bench
