// SPDX-License-Identifier: MIT
// Finds colour, depth, normals and motion among the channels of a file by the names that renderers give them. Pure
// data, no file access.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "core/result.h"

namespace afterglow {

/// One part (sub-image) of a file, as its header says.
struct FilePart {
  std::string name;                   ///< empty unless the file has named parts
  std::vector<std::string> channels;  ///< full names, in the file's order
  Rect data_window, display_window;   ///< as stored, orientation not applied
  int orientation = 1;                ///< Exif, 1…8
  std::string unreadable;             ///< why its pixels cannot be read ("deep"), or empty
};

/// Channels of one part, by index. In a colour choice they stand for R, G, B and A; A is −1 without alpha; grey has R =
/// G = B.
struct ChannelChoice {
  int part = 0;
  std::vector<int> channels;
};

/// Names of layers and channels may be given by their end, from behind a point on, where no other ends so: "albedo" for
/// "ViewLayer.albedo".

/// --layer NAME, or the usual colour layer when `name` is empty. Names: layer ("ViewLayer.Combined"), view layer
/// ("ViewLayer"), part, or a single channel (shown grey). Errors: io (there is none; lists the layers, names the
/// nearest).
Result<ChannelChoice> find_color(const std::vector<FilePart>& parts, const std::string& name);

/// Where `find_color` without a name had to take one of several layers that look alike: their names, the one that it
/// took first. Empty where the choice is plain.
std::vector<std::string> equal_colors(const std::vector<FilePart>& parts);

/// The depth channel: by `name` (channel or layer), else by the usual names, those beside the colour layer first
/// (`color`, may be null). Nothing when `name` is empty and there is none. Errors: io (no such channel).
Result<std::optional<ChannelChoice>> find_depth(const std::vector<FilePart>& parts, const std::string& name,
                                                const ChannelChoice* color);

/// The normal layer (three channels), likewise.
Result<std::optional<ChannelChoice>> find_normal(const std::vector<FilePart>& parts, const std::string& name,
                                                 const ChannelChoice* color);

/// Motion vectors, likewise: two channels (x, y), or four of Blender's Vector pass (from the previous frame, to the
/// next).
Result<std::optional<ChannelChoice>> find_motion(const std::vector<FilePart>& parts, const std::string& name,
                                                 const ChannelChoice* color);

/// The channels of a part whose names say that they are depth.
std::vector<std::string> depth_channels(const FilePart& part);

/// A layer by name, one to four channels in their usual places (R G B A, X Y Z, …; −1: it has not this one), or a
/// single channel; a single alpha four times. Nothing: there is none of that name, or several whose names end so.
std::optional<ChannelChoice> find_layer(const std::vector<FilePart>& parts, const std::string& name);

/// The names that `find_layer` knows, without those of single channels.
std::vector<std::string> layer_names(const std::vector<FilePart>& parts);

}  // namespace afterglow
