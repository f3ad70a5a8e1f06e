// SPDX-License-Identifier: MIT
#include "image/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <utility>

#include "core/text.h"
#include "image/channel_layers.h"
#include "image/layer_nearness.h"

namespace afterglow {
namespace {

ChannelChoice color_choice(const ChannelLayer& l) {
  if (has_rgb(l)) return {l.part, {red_of(l), green_of(l), blue_of(l), alpha_of(l)}};
  const int x = l.find({"x"}), y = l.find({"y"}), z = l.find({"z"});
  if (x >= 0 && y >= 0 && z >= 0) return {l.part, {x, y, z, -1}};
  if (const int grey = grey_of(l); grey >= 0) return {l.part, {grey, grey, grey, alpha_of(l)}};
  const std::array<int, 3> colors{red_of(l), green_of(l), blue_of(l)};
  const auto known = std::ranges::count_if(colors, [](int channel) { return channel >= 0; });
  if (known == 2) return {l.part, {colors[0], colors[1], colors[2], alpha_of(l)}};  // the third one is black
  if (known == 1 && l.channels.size() == (alpha_of(l) >= 0 ? 2u : 1u)) {
    const int only = *std::ranges::max_element(colors);
    return {l.part, {only, only, only, alpha_of(l)}};
  }
  if (l.channels.size() >= 3) return {l.part, {l.channels[0], l.channels[1], l.channels[2], -1}};
  return {l.part, {l.channels[0], l.channels[0], l.channels[0], -1}};
}

std::vector<const ChannelLayer*> all_of(const std::vector<ChannelLayer>& layers) {
  std::vector<const ChannelLayer*> all;
  for (const ChannelLayer& layer : layers) all.push_back(&layer);
  return all;
}

/// How likely a layer is the picture: of several eyes that of plain names first.
std::pair<int, bool> color_place(const ChannelLayer* l) { return {color_rank(*l), !l->default_view}; }

const ChannelLayer* best_color(const std::vector<const ChannelLayer*>& layers) {
  const ChannelLayer* best = nullptr;
  for (const ChannelLayer* layer : layers) {
    if (color_rank(*layer) < 0) continue;
    if (!best || color_place(layer) < color_place(best)) best = layer;
  }
  return best;
}

Beside beside_layers(const std::vector<ChannelLayer>& layers, const std::vector<ChannelLayer>& others,
                     const BesideColor& beside) {
  const auto& of = beside.parts ? others : layers;
  return {&of, beside.color ? layer_of(of, *beside.color) : nullptr, beside.parts != nullptr};
}

/// Names of a part of another eye ask for it with the part's name alone: each eye may have them.
bool of_other_eye(const ChannelLayer& l, const std::string& name, const Beside& beside) {
  if (!beside.own || l.view.empty() || beside.own->view.empty() || lower(l.view) == lower(beside.own->view))
    return false;
  const auto said = split(lower(name), '.');
  return std::ranges::find(said, lower(l.view)) == said.end();
}

using Layers = std::vector<const ChannelLayer*>;

/// Of layers that are called alike the nearest, where it is known which are near.
Layers nearest_of(Layers layers, const Beside& beside) {
  if (!beside.own || layers.size() < 2) return layers;
  std::optional<Nearness> best;
  for (const ChannelLayer* layer : layers)
    if (const auto near = nearness(*layer, beside); near && (!best || *near < *best)) best = near;
  if (best) std::erase_if(layers, [&](const ChannelLayer* layer) { return nearness(*layer, beside) != best; });
  return layers;
}

/// The layers that `name` may mean: by prefix, by part, by part and prefix, as the view layer in front of several, as
/// an eye, or by its end where all that end so, or all that are nearest, have one name.
Layers layers_named(const std::vector<FilePart>& parts, const std::vector<ChannelLayer>& layers,
                    const std::string& name, const Beside& beside = {}) {
  Layers exact, wider, eye, ending;
  for (const ChannelLayer& layer : layers) {
    const std::string& part = parts[static_cast<std::size_t>(layer.part)].name;
    const bool of_part = !part.empty() && name == part + (layer.prefix.empty() ? "" : "." + layer.prefix);
    const bool near = !of_other_eye(layer, name, beside);
    const bool one_part = beside.own && layer.part == beside.own->part;
    if (of_part || (layer.name == name && (near || one_part))) exact.push_back(&layer);
    if (part == name || layer.name.starts_with(name + ".")) wider.push_back(&layer);
    if (layer.view == name) eye.push_back(&layer);
    if (ends_so(layer.name, name) && near) ending.push_back(&layer);
  }
  if (!exact.empty()) return nearest_of(exact, beside);
  if (!wider.empty()) return wider;
  if (!eye.empty()) return eye;
  ending = nearest_of(ending, beside);
  const bool unlike =
      std::ranges::any_of(ending, [&](const ChannelLayer* l) { return l->name != ending.front()->name; });
  return unlike ? Layers() : ending;
}

/// Channels that are called so, with their part's name or without; else those whose names end so.
std::vector<ChannelChoice> channels_named(const std::vector<FilePart>& parts, const std::vector<ChannelLayer>& layers,
                                          const std::string& name, const Beside& beside) {
  std::vector<ChannelChoice> exact, ending;
  for (const ChannelLayer& layer : layers) {
    const FilePart& part = parts[static_cast<std::size_t>(layer.part)];
    for (const int c : layer.channels) {
      const std::string& channel = part.channels[static_cast<std::size_t>(c)];
      const ChannelChoice choice{layer.part, {c}};
      if (part.name + "." + channel == name) return {choice};
      const bool near = !of_other_eye(layer, name, beside);
      const bool one_part = beside.own && layer.part == beside.own->part;
      if (channel == name && (near || one_part)) exact.push_back(choice);
      if (ends_so(channel, name) && near) ending.push_back(choice);
    }
  }
  return exact.empty() ? ending : exact;
}

/// The only one, or the only one that is nearest to the colours.
std::optional<ChannelChoice> nearest_channel(const std::vector<ChannelLayer>& layers,
                                             const std::vector<ChannelChoice>& channels, const Beside& beside) {
  if (channels.size() == 1) return channels.front();
  if (!beside.own) return std::nullopt;
  Layers of;
  for (const ChannelChoice& channel : channels) of.push_back(layer_of(layers, channel));
  const Layers near = nearest_of(of, beside);
  if (near.size() != 1) return std::nullopt;
  return channels[static_cast<std::size_t>(std::ranges::find(of, near.front()) - of.begin())];
}

/// A single channel by its full name, by part and name, or by its end; the first of several that have one full name.
std::optional<ChannelChoice> channel_named(const std::vector<FilePart>& parts, const std::vector<ChannelLayer>& layers,
                                           const std::string& name, const Beside& beside = {}) {
  const auto named = channels_named(parts, layers, name, beside);
  if (auto channel = nearest_channel(layers, named, beside)) return channel;
  if (named.empty()) return std::nullopt;
  const auto& first = parts[static_cast<std::size_t>(named[0].part)].channels;
  return first[static_cast<std::size_t>(named[0].channels[0])] == name ? std::optional(named[0]) : std::nullopt;
}

std::vector<std::string> layer_names(const std::vector<ChannelLayer>& layers) {
  std::vector<std::string> names;
  for (const ChannelLayer& layer : layers) {
    const std::string& shown = layer.shown;
    if (!shown.empty() && std::find(names.begin(), names.end(), shown) == names.end()) names.push_back(shown);
  }
  return names;
}

std::vector<std::string> channel_names(const std::vector<FilePart>& parts) {
  std::vector<std::string> names;
  for (const FilePart& part : parts) {
    if (!part.unreadable.empty()) continue;
    for (const std::string& channel : part.channels) {
      const bool clash = std::find(names.begin(), names.end(), channel) != names.end();
      names.push_back(clash ? part.name + "." + channel : channel);
    }
  }
  return names;
}

/// The list in an error: long ones are cut, names with commas or spaces are in quotation marks, as they are typed.
std::string listed(std::vector<std::string> names) {
  constexpr std::size_t kMost = 40;
  for (std::string& name : names)
    if (name.find_first_of(", ") != std::string::npos) name = "'" + name + "'";
  if (names.size() <= kMost) return join(names);
  return join(std::vector<std::string>(names.begin(), names.begin() + kMost)) +
         fmt::format(" and {} more", names.size() - kMost);
}

Error not_found(const std::vector<FilePart>& parts, const std::vector<ChannelLayer>& layers, const std::string& what,
                const std::string& name) {
  for (const FilePart& part : parts)
    if (part.name == name && !part.unreadable.empty()) return Error{ErrorKind::io, part.unreadable};
  std::vector<std::string> known = layer_names(layers), ending;
  for (const std::string& channel : channel_names(parts)) known.push_back(channel);
  for (const std::string& full : known)
    if (ends_so(full, name)) ending.push_back(full);
  if (ending.size() > 1)
    return Error{ErrorKind::io, fmt::format("has several of which each may be the {} '{}'", what, name), "", 0,
                 listed(ending)};
  return Error{
      ErrorKind::io, fmt::format("has no {} '{}'", what, name), "", 0, listed(known), nearest_name(name, known)};
}

std::optional<Error> nothing_readable(const std::vector<FilePart>& parts, const std::vector<ChannelLayer>& layers) {
  if (!layers.empty()) return std::nullopt;
  for (const FilePart& part : parts)
    if (!part.unreadable.empty()) return Error{ErrorKind::io, part.unreadable};
  return Error{ErrorKind::io, "has no channels"};
}

/// The depth channel of a layer, or −1. `certain`: the name says depth; else any single channel will do.
int depth_of(const ChannelLayer& l, bool certain) {
  if (certain && l.last == "mist") return -1;  // 0…1, between two distances that nobody knows
  const bool vector = l.find({"x"}) >= 0;
  if (!vector)
    if (const int z = l.find({"z"}); z >= 0 && !named_normal(l)) return z;
  if (const int z = l.find({"depth", "zdepth", "pz"}); z >= 0) return z;
  if (certain && !named_depth(l)) return -1;
  if (l.channels.size() == 1) return l.channels[0];
  if (const int z = l.find({"v", "y", "r"}); z >= 0) return z;
  return certain ? -1 : l.channels[0];
}

/// A "Z" in a layer of another name: "Denoising Depth.Z", which has 0 where nothing is, comes before "Depth.Z" in
/// files.
bool unsure_depth(const ChannelLayer& l) {
  return !l.name.empty() && !named_depth(l) && !has_rgb(l) && l.find({"depth", "zdepth", "pz"}) < 0;
}

std::optional<std::vector<int>> normal_of(const ChannelLayer& l, bool certain) {
  if (certain && !named_normal(l)) {
    const int x = l.find({"nx"}), y = l.find({"ny"}), z = l.find({"nz"});
    if (x >= 0 && y >= 0 && z >= 0) return std::vector<int>{x, y, z};
    return std::nullopt;
  }
  const int x = l.find({"x"}), y = l.find({"y"}), z = l.find({"z"});
  if (x >= 0 && y >= 0 && z >= 0) return std::vector<int>{x, y, z};
  if (has_rgb(l)) return std::vector<int>{red_of(l), green_of(l), blue_of(l)};
  if (l.channels.size() == 3) return l.channels;
  return std::nullopt;
}

std::optional<std::vector<int>> motion_of(const ChannelLayer& l, bool certain) {
  if (certain && !named_motion(l)) return std::nullopt;
  const int x = l.find({"x"}), y = l.find({"y"}), z = l.find({"z"}), w = l.find({"w"});
  if (x >= 0 && y >= 0 && z >= 0 && w >= 0) return std::vector<int>{x, y, z, w};
  if (x >= 0 && y >= 0) return std::vector<int>{x, y};
  const int u = l.find({"u"}), v = l.find({"v"});
  if (u >= 0 && v >= 0) return std::vector<int>{u, v};
  if (red_of(l) >= 0 && green_of(l) >= 0) return std::vector<int>{red_of(l), green_of(l)};
  if (l.channels.size() == 2) return l.channels;
  return std::nullopt;
}

std::vector<ChannelLayer> layers_of_other(const BesideColor& color) {
  return color.parts ? layers_of(*color.parts) : std::vector<ChannelLayer>();
}

std::optional<std::vector<int>> depth_offer(const ChannelLayer& layer) {
  const int channel = depth_of(layer, true);
  return channel < 0 ? std::nullopt : std::optional(std::vector<int>{channel});
}

using VectorsOf = std::optional<std::vector<int>> (*)(const ChannelLayer&, bool certain);

Result<std::optional<ChannelChoice>> find_vectors(const std::vector<FilePart>& parts, const std::string& name,
                                                  const BesideColor& color, VectorsOf vectors_of, const char* what) {
  const std::vector<ChannelLayer> layers = layers_of(parts), others = layers_of_other(color);
  const Beside beside = beside_layers(layers, others, color);
  if (name.empty()) return nearest(all_of(layers), beside, [&](const ChannelLayer& l) { return vectors_of(l, true); });
  for (const bool certain : {true, false})
    for (const ChannelLayer* layer : layers_named(parts, layers, name, beside))
      if (auto channels = vectors_of(*layer, certain))
        return std::optional(ChannelChoice{layer->part, std::move(*channels)});
  return not_found(parts, layers, what, name);
}

}  // namespace

Result<ChannelChoice> find_color(const std::vector<FilePart>& parts, const std::string& name) {
  const std::vector<ChannelLayer> layers = layers_of(parts);
  if (const auto error = nothing_readable(parts, layers)) return *error;
  if (name.empty()) {
    if (const ChannelLayer* best = best_color(all_of(layers))) return color_choice(*best);
    // A single unnamed channel ("channel0", "I") is a grey picture.
    if (layers.size() == 1 && layers[0].name.empty() && color_rank(layers[0]) >= 0) return color_choice(layers[0]);
    if (layers.size() == 1 && layers[0].find({"z", "x"}) < 0 && !named_depth(layers[0]) && !named_normal(layers[0]))
      return color_choice(layers[0]);
    return Error{ErrorKind::io, "has no colour layer; choose one with --layer", "", 0, listed(channel_names(parts))};
  }
  const Layers named = layers_named(parts, layers, name);
  if (!named.empty()) {
    const ChannelLayer* best = best_color(named);
    return color_choice(best ? *best : *named.front());
  }
  if (const auto channel = channel_named(parts, layers, name)) {
    const int c = channel->channels[0];
    return ChannelChoice{channel->part, {c, c, c, -1}};
  }
  return not_found(parts, layers, "layer", name);
}

std::vector<std::string> equal_colors(const std::vector<FilePart>& parts) {
  const std::vector<ChannelLayer> layers = layers_of(parts);
  const ChannelLayer* best = best_color(all_of(layers));
  if (!best) return {};
  std::vector<std::string> names{best->shown};
  for (const ChannelLayer& layer : layers)
    if (&layer != best && color_rank(layer) == color_rank(*best)) names.push_back(layer.shown);
  return names.size() > 1 ? names : std::vector<std::string>();
}

Result<std::optional<ChannelChoice>> find_depth(const std::vector<FilePart>& parts, const std::string& name,
                                                BesideColor color) {
  const std::vector<ChannelLayer> layers = layers_of(parts), others = layers_of_other(color);
  const Beside beside = beside_layers(layers, others, color);
  if (name.empty()) return nearest(all_of(layers), beside, depth_offer, unsure_depth);
  if (const auto channel = channel_named(parts, layers, name, beside)) return channel;
  // Of several channels that end so ("Z"), the one that is depth.
  std::vector<ChannelChoice> depths;
  for (const ChannelChoice& channel : channels_named(parts, layers, name, beside))
    for (const ChannelLayer& layer : layers)
      if (layer.part == channel.part && depth_of(layer, true) == channel.channels[0]) depths.push_back(channel);
  if (auto depth = nearest_channel(layers, depths, beside)) return depth;
  for (const bool certain : {true, false})
    for (const ChannelLayer* layer : layers_named(parts, layers, name, beside))
      if (const int channel = depth_of(*layer, certain); channel >= 0)
        return std::optional(ChannelChoice{layer->part, {channel}});
  return not_found(parts, layers, "depth channel", name);
}

std::vector<std::string> depth_channels(const FilePart& part) {
  std::vector<std::string> names;
  for (const ChannelLayer& layer : layers_of({part})) {
    const int found = depth_of(layer, true);
    for (const int channel : layer.channels)
      if (channel == found || (named_depth(layer) && channel != alpha_of(layer)))
        names.push_back(part.channels[static_cast<std::size_t>(channel)]);
  }
  return names;
}

Result<std::optional<ChannelChoice>> find_normal(const std::vector<FilePart>& parts, const std::string& name,
                                                 BesideColor color) {
  return find_vectors(parts, name, color, normal_of, "normal layer");
}

Result<std::optional<ChannelChoice>> find_motion(const std::vector<FilePart>& parts, const std::string& name,
                                                 BesideColor color) {
  return find_vectors(parts, name, color, motion_of, "motion layer");
}

std::optional<ChannelChoice> find_layer(const std::vector<FilePart>& parts, const std::string& name,
                                        BesideColor color) {
  const std::vector<ChannelLayer> layers = layers_of(parts), others = layers_of_other(color);
  const Beside beside = beside_layers(layers, others, color);
  const auto named = layers_named(parts, layers, name, beside);
  if (named.empty() || (named.size() > 1 && named.front()->name != name))
    return channel_named(parts, layers, name, beside);
  const ChannelLayer& layer = *named.front();
  for (const auto& usual : {std::vector<const char*>{"r", "g", "b", "a"},
                            {"red", "green", "blue", "alpha"},
                            {"x", "y", "z", "w"},
                            {"u", "v"}}) {
    std::vector<int> channels;
    for (const char* suffix : usual) channels.push_back(layer.find({suffix}));
    const auto there = std::ranges::count_if(channels, [](int channel) { return channel >= 0; });
    if (there == 0) continue;
    // A single one is in the first place, alpha in its own, too.
    const bool alpha = channels.size() == 4 && channels[3] >= 0;
    if (there == 1) return ChannelChoice{layer.part, std::vector<int>(alpha ? 4 : 1, std::ranges::max(channels))};
    while (channels.back() < 0) channels.pop_back();
    return ChannelChoice{layer.part, std::move(channels)};
  }
  std::vector<int> channels = layer.channels;
  channels.resize(std::min<std::size_t>(channels.size(), 4));
  return ChannelChoice{layer.part, std::move(channels)};
}

std::vector<std::string> likely_names(const std::vector<FilePart>& parts, const std::string& kind) {
  const std::vector<ChannelLayer> layers = layers_of(parts);
  const bool depth = kind == "depth";
  const VectorsOf vectors_of = kind == "normal" ? normal_of : motion_of;
  const auto offer = [&](const ChannelLayer& layer, bool certain) -> std::optional<std::vector<int>> {
    if (!depth) return vectors_of(layer, certain);
    if (certain) return depth_offer(layer);
    return layer.channels.size() == 1 ? std::optional(layer.channels) : std::nullopt;
  };
  const auto looks_like = [&](const ChannelLayer& layer) {
    const auto holds = [&](std::initializer_list<const char*> words) {
      return std::ranges::any_of(words, [&](const char* word) { return layer.last.find(word) != std::string::npos; });
    };
    return depth              ? holds({"depth", "dist", "mist"})
           : kind == "normal" ? holds({"norm"})
                              : holds({"motion", "vel", "mv"});
  };
  std::vector<std::string> names;
  for (const bool certain : {true, false})
    for (const ChannelLayer& layer : layers) {
      if (!certain && !looks_like(layer)) continue;
      const auto channels = offer(layer, certain);
      std::string name = channels ? choice_name(parts, {layer.part, *channels}) : "";
      if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
    }
  return names;
}

std::vector<std::string> layer_names(const std::vector<FilePart>& parts) { return layer_names(layers_of(parts)); }

}  // namespace afterglow
