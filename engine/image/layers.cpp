// SPDX-License-Identifier: MIT
#include "image/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <utility>

#include "core/text.h"

namespace afterglow {
namespace {

/// Channels of one part that share everything before the last dot of their names.
struct Layer {
  int part = 0;
  std::string prefix;  ///< before the last dot; empty for plain R, G, B
  std::string name;    ///< what users call it: the prefix, or the part's name
  std::string last;    ///< last component of `name`, lower case: "combined", "depth", "n"
  std::string group;   ///< what stands before that: the view layer
  std::vector<int> channels;
  std::vector<std::string> suffixes;  ///< lower case: "r", "z", …

  int find(std::initializer_list<const char*> names) const {
    for (const char* wanted : names)
      for (std::size_t i = 0; i < suffixes.size(); ++i)
        if (suffixes[i] == wanted) return channels[i];
    return -1;
  }
};

bool any_of(const std::string& text, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(), [&](const char* name) { return text == name; });
}

std::vector<Layer> layers_of(const std::vector<FilePart>& parts) {
  std::vector<Layer> layers;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!parts[p].unreadable.empty()) continue;
    const std::size_t first = layers.size();
    for (std::size_t c = 0; c < parts[p].channels.size(); ++c) {
      const std::string& full = parts[p].channels[c];
      const std::size_t dot = full.rfind('.');
      const std::string prefix = dot == std::string::npos ? "" : full.substr(0, dot);
      auto layer = std::find_if(layers.begin() + static_cast<std::ptrdiff_t>(first), layers.end(),
                                [&](const Layer& l) { return l.prefix == prefix; });
      if (layer == layers.end()) {
        Layer made;
        made.part = static_cast<int>(p);
        made.prefix = prefix;
        made.name = prefix.empty() ? parts[p].name : prefix;
        const std::size_t cut = made.name.rfind('.');
        made.last = lower(cut == std::string::npos ? made.name : made.name.substr(cut + 1));
        made.group = cut == std::string::npos ? "" : made.name.substr(0, cut);
        layer = layers.insert(layers.end(), std::move(made));
      }
      layer->channels.push_back(static_cast<int>(c));
      layer->suffixes.push_back(lower(dot == std::string::npos ? full : full.substr(dot + 1)));
    }
  }
  return layers;
}

bool named_normal(const Layer& layer) { return any_of(layer.last, {"n", "normal", "normals", "norm", "nn"}); }
bool named_motion(const Layer& layer) {
  return any_of(layer.last, {"vector", "motion", "motionvector", "motionvectors", "motion_vector", "motion_vectors",
                             "velocity", "forward", "mv", "mvec"});
}
bool named_depth(const Layer& layer) { return any_of(layer.last, {"z", "depth", "zdepth", "pz"}); }

int red_of(const Layer& l) { return l.find({"r", "red"}); }
int green_of(const Layer& l) { return l.find({"g", "green"}); }
int blue_of(const Layer& l) { return l.find({"b", "blue"}); }
int alpha_of(const Layer& l) { return l.find({"a", "alpha"}); }
bool has_rgb(const Layer& l) { return red_of(l) >= 0 && green_of(l) >= 0 && blue_of(l) >= 0; }
int grey_of(const Layer& l) { return l.find({"y", "l", "gray", "grey", "luminance"}); }

ChannelChoice color_choice(const Layer& l) {
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

/// How likely a layer is the picture itself: small is likely, negative never.
int color_rank(const Layer& l) {
  if (named_normal(l) || named_depth(l) || named_motion(l)) return -1;
  if (has_rgb(l)) {
    if (l.name.empty()) return 0;
    if (l.last == "combined") return 1;
    if (any_of(l.last, {"rgba", "rgb", "beauty", "c", "color", "colour", "main", "default", "image", "final"}))
      return 2;
    return 4;
  }
  if (grey_of(l) < 0 || l.find({"x"}) >= 0) return -1;
  return l.name.empty() ? 3 : 5;
}

std::vector<const Layer*> all_of(const std::vector<Layer>& layers) {
  std::vector<const Layer*> all;
  for (const Layer& layer : layers) all.push_back(&layer);
  return all;
}

const Layer* best_color(const std::vector<const Layer*>& layers) {
  const Layer* best = nullptr;
  for (const Layer* layer : layers) {
    if (color_rank(*layer) < 0) continue;
    if (!best || color_rank(*layer) < color_rank(*best)) best = layer;
  }
  return best;
}

bool ends_so(const std::string& full, const std::string& end) { return full.ends_with("." + end); }

/// The layers that `name` may mean: by prefix, by part, by part and prefix, as the view layer in front of several, or
/// by its end where all that end so have one name.
std::vector<const Layer*> layers_named(const std::vector<FilePart>& parts, const std::vector<Layer>& layers,
                                       const std::string& name) {
  std::vector<const Layer*> exact, wider;
  for (const Layer& layer : layers) {
    const std::string& part = parts[static_cast<std::size_t>(layer.part)].name;
    const bool of_part = !part.empty() && name == part + (layer.prefix.empty() ? "" : "." + layer.prefix);
    if (layer.name == name || of_part) {
      exact.push_back(&layer);
    } else if (part == name || layer.name.starts_with(name + ".")) {
      wider.push_back(&layer);
    }
  }
  if (!exact.empty()) return exact;
  if (!wider.empty()) return wider;
  std::vector<const Layer*> ending;
  for (const Layer& layer : layers)
    if (ends_so(layer.name, name)) ending.push_back(&layer);
  const bool unlike = std::ranges::any_of(ending, [&](const Layer* l) { return l->name != ending.front()->name; });
  return unlike ? std::vector<const Layer*>() : ending;
}

/// Channels whose names end so.
std::vector<ChannelChoice> channels_ending(const std::vector<FilePart>& parts, const std::string& name) {
  std::vector<ChannelChoice> out;
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (std::size_t c = 0; c < parts[p].channels.size(); ++c)
      if (parts[p].unreadable.empty() && ends_so(parts[p].channels[c], name))
        out.push_back({static_cast<int>(p), {static_cast<int>(c)}});
  return out;
}

/// A single channel by its full name, by part and name, or by its end where no other ends so.
std::optional<ChannelChoice> channel_named(const std::vector<FilePart>& parts, const std::string& name) {
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!parts[p].unreadable.empty()) continue;
    for (std::size_t c = 0; c < parts[p].channels.size(); ++c)
      if (parts[p].channels[c] == name || parts[p].name + "." + parts[p].channels[c] == name)
        return ChannelChoice{static_cast<int>(p), {static_cast<int>(c)}};
  }
  const auto ending = channels_ending(parts, name);
  return ending.size() == 1 ? std::optional(ending.front()) : std::nullopt;
}

std::vector<std::string> layer_names(const std::vector<Layer>& layers) {
  std::vector<std::string> names;
  for (const Layer& layer : layers) {
    const std::string& shown = layer.name;
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

/// The list in an error: long ones are cut.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 40;
  if (names.size() <= kMost) return join(names);
  return join(std::vector<std::string>(names.begin(), names.begin() + kMost)) +
         fmt::format(" and {} more", names.size() - kMost);
}

Error not_found(const std::vector<FilePart>& parts, const std::vector<Layer>& layers, const std::string& what,
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

std::optional<Error> nothing_readable(const std::vector<FilePart>& parts, const std::vector<Layer>& layers) {
  if (!layers.empty()) return std::nullopt;
  for (const FilePart& part : parts)
    if (!part.unreadable.empty()) return Error{ErrorKind::io, part.unreadable};
  return Error{ErrorKind::io, "has no channels"};
}

/// The depth channel of a layer, or −1. `certain`: the name says depth; else any single channel will do.
int depth_of(const Layer& l, bool certain) {
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
bool unsure_depth(const Layer& l) {
  return !l.name.empty() && !named_depth(l) && !has_rgb(l) && l.find({"depth", "zdepth", "pz"}) < 0;
}

std::optional<std::vector<int>> normal_of(const Layer& l, bool certain) {
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

std::optional<std::vector<int>> motion_of(const Layer& l, bool certain) {
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

/// Candidates in order of nearness to the colour layer: itself, its eye of a stereo picture ("depth.right" beside
/// "rgba.right"; in the same view layer first), its view layer, plain ones, the rest. Of those that are equally near,
/// the ones that are `unsure` come last.
std::vector<const Layer*> by_nearness(const std::vector<Layer>& layers, const ChannelChoice* color,
                                      bool (*unsure)(const Layer&) = nullptr) {
  const Layer* own = nullptr;
  for (const Layer& layer : layers)
    if (color && layer.part == color->part &&
        std::ranges::find(layer.channels, color->channels[0]) != layer.channels.end())
      own = &layer;
  const auto first = [](const Layer& l) { return l.name.substr(0, l.name.find('.')); };
  const auto distance = [&](const Layer* l) {
    if (!own) return l->group.empty() ? 4 : 5;
    if (l == own) return 0;
    if (l->last == own->last && !own->last.empty()) return first(*l) == first(*own) ? 1 : 2;
    return l->group == own->group ? 3 : l->group.empty() ? 4 : 5;
  };
  const auto place = [&](const Layer* l) { return std::pair(distance(l), unsure && unsure(*l)); };
  std::vector<const Layer*> sorted = all_of(layers);
  std::stable_sort(sorted.begin(), sorted.end(), [&](const Layer* a, const Layer* b) { return place(a) < place(b); });
  return sorted;
}

}  // namespace

Result<ChannelChoice> find_color(const std::vector<FilePart>& parts, const std::string& name) {
  const std::vector<Layer> layers = layers_of(parts);
  if (const auto error = nothing_readable(parts, layers)) return *error;
  if (name.empty()) {
    if (const Layer* best = best_color(all_of(layers))) return color_choice(*best);
    // A single unnamed channel ("channel0", "I") is a grey picture.
    if (layers.size() == 1 && layers[0].name.empty() && color_rank(layers[0]) >= 0) return color_choice(layers[0]);
    if (layers.size() == 1 && layers[0].find({"z", "x"}) < 0 && !named_depth(layers[0]) && !named_normal(layers[0]))
      return color_choice(layers[0]);
    return Error{ErrorKind::io, "has no colour layer; choose one with --layer", "", 0, listed(channel_names(parts))};
  }
  const std::vector<const Layer*> named = layers_named(parts, layers, name);
  if (!named.empty()) {
    const Layer* best = best_color(named);
    return color_choice(best ? *best : *named.front());
  }
  if (const auto channel = channel_named(parts, name)) {
    const int c = channel->channels[0];
    return ChannelChoice{channel->part, {c, c, c, -1}};
  }
  return not_found(parts, layers, "layer", name);
}

std::vector<std::string> equal_colors(const std::vector<FilePart>& parts) {
  constexpr int kFirstUnsure = 4;  // of `color_rank`: names that say nothing
  const std::vector<Layer> layers = layers_of(parts);
  const Layer* best = best_color(all_of(layers));
  if (!best || color_rank(*best) < kFirstUnsure) return {};
  std::vector<std::string> names;
  for (const Layer& layer : layers)
    if (color_rank(layer) == color_rank(*best)) names.push_back(layer.name);
  return names.size() > 1 ? names : std::vector<std::string>();
}

Result<std::optional<ChannelChoice>> find_depth(const std::vector<FilePart>& parts, const std::string& name,
                                                const ChannelChoice* color) {
  const std::vector<Layer> layers = layers_of(parts);
  if (name.empty()) {
    for (const Layer* layer : by_nearness(layers, color, unsure_depth))
      if (const int channel = depth_of(*layer, true); channel >= 0)
        return std::optional(ChannelChoice{layer->part, {channel}});
    return std::optional<ChannelChoice>();
  }
  if (const auto channel = channel_named(parts, name)) return channel;
  // Of several channels that end so ("Z"), the one that is depth.
  std::vector<ChannelChoice> depths;
  for (const ChannelChoice& channel : channels_ending(parts, name))
    for (const Layer& layer : layers)
      if (layer.part == channel.part && depth_of(layer, true) == channel.channels[0]) depths.push_back(channel);
  if (depths.size() == 1) return std::optional(depths.front());
  for (const Layer* layer : layers_named(parts, layers, name))
    if (const int channel = depth_of(*layer, true); channel >= 0)
      return std::optional(ChannelChoice{layer->part, {channel}});
  for (const Layer* layer : layers_named(parts, layers, name))
    return std::optional(ChannelChoice{layer->part, {depth_of(*layer, false)}});
  return not_found(parts, layers, "depth channel", name);
}

std::vector<std::string> depth_channels(const FilePart& part) {
  std::vector<std::string> names;
  for (const Layer& layer : layers_of({part})) {
    const int found = depth_of(layer, true);
    for (const int channel : layer.channels)
      if (channel == found || (named_depth(layer) && channel != alpha_of(layer)))
        names.push_back(part.channels[static_cast<std::size_t>(channel)]);
  }
  return names;
}

Result<std::optional<ChannelChoice>> find_normal(const std::vector<FilePart>& parts, const std::string& name,
                                                 const ChannelChoice* color) {
  const std::vector<Layer> layers = layers_of(parts);
  if (name.empty()) {
    for (const Layer* layer : by_nearness(layers, color))
      if (auto channels = normal_of(*layer, true))
        return std::optional(ChannelChoice{layer->part, std::move(*channels)});
    return std::optional<ChannelChoice>();
  }
  for (const bool certain : {true, false})
    for (const Layer* layer : layers_named(parts, layers, name))
      if (auto channels = normal_of(*layer, certain))
        return std::optional(ChannelChoice{layer->part, std::move(*channels)});
  return not_found(parts, layers, "normal layer", name);
}

Result<std::optional<ChannelChoice>> find_motion(const std::vector<FilePart>& parts, const std::string& name,
                                                 const ChannelChoice* color) {
  const std::vector<Layer> layers = layers_of(parts);
  if (name.empty()) {
    for (const Layer* layer : by_nearness(layers, color))
      if (auto channels = motion_of(*layer, true))
        return std::optional(ChannelChoice{layer->part, std::move(*channels)});
    return std::optional<ChannelChoice>();
  }
  for (const bool certain : {true, false})
    for (const Layer* layer : layers_named(parts, layers, name))
      if (auto channels = motion_of(*layer, certain))
        return std::optional(ChannelChoice{layer->part, std::move(*channels)});
  return not_found(parts, layers, "motion layer", name);
}

std::optional<ChannelChoice> find_layer(const std::vector<FilePart>& parts, const std::string& name) {
  const std::vector<Layer> layers = layers_of(parts);
  const auto named = layers_named(parts, layers, name);
  if (named.empty() || (named.size() > 1 && named.front()->name != name)) return channel_named(parts, name);
  const Layer& layer = *named.front();
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

std::vector<std::string> layer_names(const std::vector<FilePart>& parts) { return layer_names(layers_of(parts)); }

}  // namespace afterglow
