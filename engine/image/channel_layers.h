// SPDX-License-Identifier: MIT
// Channels of a file as layers: what shares everything before the last dot of its names, what renderers mean by the
// names, and of which part, eye and view layer each is. Used by layers.cpp and layer_nearness.cpp alone.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "image/layers.h"

namespace afterglow {

/// Channels of one part that share everything before the last dot of their names.
struct ChannelLayer {
  int part = 0;
  std::string prefix;  ///< before the last dot; empty for plain R, G, B
  std::string name;    ///< what users call it: the prefix, or the part's name
  std::string shown;   ///< the same, with the part before it where two layers have one name, or the eye where it is ""
  std::string last;    ///< last component of `path`, lower case: "combined", "depth", "n"
  std::vector<std::string> path;  ///< components of `name` without the eye
  /// The eye of a stereo picture: as the file says it (`view`, `multiView`), or a component "left" or "right". Empty:
  /// none, or what all have in common.
  std::string view;
  bool default_view = true;  ///< false: the file puts another eye before it
  std::vector<int> channels;
  std::vector<std::string> suffixes;  ///< lower case: "r", "z", …

  int find(std::initializer_list<const char*> names) const;
};

/// Of parts that can be read, in the file's order.
std::vector<ChannelLayer> layers_of(const std::vector<FilePart>& parts);
/// The layer that the first of these channels is of; null: none.
const ChannelLayer* layer_of(const std::vector<ChannelLayer>& layers, const ChannelChoice& choice);

bool any_of(const std::string& text, std::initializer_list<const char*> names);
bool ends_so(const std::string& full, const std::string& end);  ///< from behind a point on

bool named_normal(const ChannelLayer& layer);
bool named_motion(const ChannelLayer& layer);
bool named_depth(const ChannelLayer& layer);

int red_of(const ChannelLayer& layer);
int green_of(const ChannelLayer& layer);
int blue_of(const ChannelLayer& layer);
int alpha_of(const ChannelLayer& layer);
int grey_of(const ChannelLayer& layer);
bool has_rgb(const ChannelLayer& layer);

/// How likely a layer is the picture itself: small is likely, negative never. Up to kMainPicture its name says so.
inline constexpr int kMainPicture = 2;
int color_rank(const ChannelLayer& layer);

}  // namespace afterglow
