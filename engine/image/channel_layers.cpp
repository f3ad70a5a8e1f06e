// SPDX-License-Identifier: MIT
#include "image/channel_layers.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "core/text.h"

namespace afterglow {
namespace {

std::vector<std::string> components(const std::string& name) {
  return name.empty() ? std::vector<std::string>() : split(name, '.');
}

bool is_eye(const std::string& component) { return any_of(lower(component), {"left", "right"}); }

/// The eye among the components of a name, which loses it there: one that the file names, else left or right.
std::string take_view(std::vector<std::string>& path, const std::vector<std::string>& known) {
  for (auto at = path.rbegin(); at != path.rend(); ++at) {
    if (std::ranges::find(known, *at) == known.end() && !is_eye(*at)) continue;
    std::string view = std::move(*at);
    path.erase(std::next(at).base());
    return view;
  }
  return {};
}

void place_layer(ChannelLayer& layer, const FilePart& part) {
  layer.path = components(layer.name);
  std::string said = take_view(layer.path, part.views);
  if (!part.view.empty()) {
    // A part of an eye is called after it where it has no other name.
    std::erase(layer.path, part.view);
    said = part.view;
  } else if (said.empty() && !layer.prefix.empty()) {
    std::vector<std::string> of_part = components(part.name);
    said = take_view(of_part, part.views);
  }
  if (said.empty() && !part.views.empty()) said = part.views.front();  // plain names are those of the first
  layer.view = std::move(said);
  layer.default_view = part.views.empty() || layer.view == part.views.front();
  layer.last = layer.path.empty() ? "" : lower(layer.path.back());
}

/// Where names alone say the eyes: beside "right.R" and no "left.R" plain R is the other eye.
void name_other_eye(std::vector<ChannelLayer>& layers) {
  std::vector<std::string> eyes;
  bool plain = false;
  for (const ChannelLayer& layer : layers) {
    if (!has_rgb(layer)) continue;
    if (layer.view.empty()) {
      plain = true;
    } else if (!is_eye(layer.view)) {
      return;
    } else if (std::ranges::find(eyes, layer.view) == eyes.end()) {
      eyes.push_back(layer.view);
    }
  }
  if (!plain || eyes.size() != 1) return;
  const std::string other = lower(eyes.front()) == "left" ? "right" : "left";
  for (ChannelLayer& layer : layers) {
    if (layer.view.empty()) {
      layer.view = other;
    } else {
      layer.default_view = false;
    }
  }
}

/// Names by which people can tell layers apart.
void show_names(const std::vector<FilePart>& parts, std::vector<ChannelLayer>& layers) {
  for (ChannelLayer& layer : layers) {
    const std::string& part = parts[static_cast<std::size_t>(layer.part)].name;
    const auto alike = std::ranges::count(layers, layer.name, &ChannelLayer::name);
    layer.shown = layer.name.empty()                                    ? layer.view
                  : alike > 1 && !part.empty() && !layer.prefix.empty() ? part + "." + layer.name
                                                                        : layer.name;
  }
}

}  // namespace

int ChannelLayer::find(std::initializer_list<const char*> names) const {
  for (const char* wanted : names)
    for (std::size_t i = 0; i < suffixes.size(); ++i)
      if (suffixes[i] == wanted) return channels[i];
  return -1;
}

bool any_of(const std::string& text, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(), [&](const char* name) { return text == name; });
}

bool ends_so(const std::string& full, const std::string& end) { return full.ends_with("." + end); }

std::vector<ChannelLayer> layers_of(const std::vector<FilePart>& parts) {
  std::vector<ChannelLayer> layers;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!parts[p].unreadable.empty()) continue;
    const std::size_t first = layers.size();
    for (std::size_t c = 0; c < parts[p].channels.size(); ++c) {
      const std::string& full = parts[p].channels[c];
      const std::size_t dot = full.rfind('.');
      const std::string prefix = dot == std::string::npos ? "" : full.substr(0, dot);
      auto layer = std::find_if(layers.begin() + static_cast<std::ptrdiff_t>(first), layers.end(),
                                [&](const ChannelLayer& l) { return l.prefix == prefix; });
      if (layer == layers.end()) {
        ChannelLayer made;
        made.part = static_cast<int>(p);
        made.prefix = prefix;
        made.name = prefix.empty() ? parts[p].name : prefix;
        place_layer(made, parts[p]);
        layer = layers.insert(layers.end(), std::move(made));
      }
      layer->channels.push_back(static_cast<int>(c));
      layer->suffixes.push_back(lower(dot == std::string::npos ? full : full.substr(dot + 1)));
    }
  }
  name_other_eye(layers);
  show_names(parts, layers);
  return layers;
}

const ChannelLayer* layer_of(const std::vector<ChannelLayer>& layers, const ChannelChoice& choice) {
  const auto used = std::ranges::find_if(choice.channels, [](int channel) { return channel >= 0; });
  if (used == choice.channels.end()) return nullptr;
  for (const ChannelLayer& layer : layers)
    if (layer.part == choice.part && std::ranges::find(layer.channels, *used) != layer.channels.end()) return &layer;
  return nullptr;
}

bool named_normal(const ChannelLayer& layer) { return any_of(layer.last, {"n", "normal", "normals", "norm", "nn"}); }
bool named_motion(const ChannelLayer& layer) {
  return any_of(layer.last, {"vector", "motion", "motionvector", "motionvectors", "motion_vector", "motion_vectors",
                             "velocity", "forward", "mv", "mvec"});
}
bool named_depth(const ChannelLayer& layer) { return any_of(layer.last, {"z", "depth", "zdepth", "pz"}); }

int red_of(const ChannelLayer& l) { return l.find({"r", "red"}); }
int green_of(const ChannelLayer& l) { return l.find({"g", "green"}); }
int blue_of(const ChannelLayer& l) { return l.find({"b", "blue"}); }
int alpha_of(const ChannelLayer& l) { return l.find({"a", "alpha"}); }
int grey_of(const ChannelLayer& l) { return l.find({"y", "l", "gray", "grey", "luminance"}); }
bool has_rgb(const ChannelLayer& l) { return red_of(l) >= 0 && green_of(l) >= 0 && blue_of(l) >= 0; }

int color_rank(const ChannelLayer& l) {
  if (named_normal(l) || named_depth(l) || named_motion(l)) return -1;
  if (has_rgb(l)) {
    if (l.name.empty()) return 0;
    if (l.last == "combined") return lower(l.path.front()) == "composite" ? 0 : 1;
    if (l.path.empty()) return kMainPicture;  // "left.R": the picture of an eye
    if (any_of(l.last, {"rgba", "rgb", "beauty", "c", "color", "colour", "main", "default", "image", "final"}))
      return kMainPicture;
    return 4;
  }
  if (grey_of(l) < 0 || l.find({"x"}) >= 0) return -1;
  return l.name.empty() ? 3 : 5;
}

}  // namespace afterglow
