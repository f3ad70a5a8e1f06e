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
  std::string name;                     ///< empty unless the file has named parts
  std::vector<std::string> channels;    ///< full names, in the file's order
  Rect data_window, display_window;     ///< as stored, orientation not applied
  int orientation = 1;                  ///< Exif, 1…8
  std::string view = {};                ///< the eye of a stereo picture that the part is of; empty: it does not say
  std::vector<std::string> views = {};  ///< of a part that holds several: the eyes, that of plain names first
  std::string unreadable;               ///< why its pixels cannot be read ("deep"), or empty
};

/// Channels of one part, by index. In a colour choice they stand for R, G, B and A; A is −1 without alpha; grey has R =
/// G = B.
struct ChannelChoice {
  int part = 0;
  std::vector<int> channels;
  std::vector<ChannelChoice> equal = {};  ///< others that stand as near, where one had to be taken
};

/// What other images are looked for beside: the colours, and the parts of their file where that is another than the one
/// that is looked through. Null colours: they are not known.
struct BesideColor {
  const ChannelChoice* color = nullptr;
  const std::vector<FilePart>* parts = nullptr;
  BesideColor(const ChannelChoice* chosen = nullptr, const std::vector<FilePart>* of = nullptr)
      : color(chosen), parts(of) {}
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

/// The depth channel: by `name` (channel or layer), else by the usual names, what stands nearest to the colours: their
/// own layer, their view layer, what belongs to no layer. What belongs to another view layer or eye is taken for its
/// name alone. Nothing when `name` is empty and there is none. Errors: io (no such channel).
Result<std::optional<ChannelChoice>> find_depth(const std::vector<FilePart>& parts, const std::string& name,
                                                BesideColor beside);

/// The normal layer (three channels), likewise.
Result<std::optional<ChannelChoice>> find_normal(const std::vector<FilePart>& parts, const std::string& name,
                                                 BesideColor beside);

/// Motion vectors, likewise: two channels (x, y), or four of Blender's Vector pass (from the previous frame, to the
/// next).
Result<std::optional<ChannelChoice>> find_motion(const std::vector<FilePart>& parts, const std::string& name,
                                                 BesideColor beside);

/// The channels of a part whose names say that they are depth.
std::vector<std::string> depth_channels(const FilePart& part);

/// A layer by name, one to four channels in their usual places (R G B A, X Y Z, …; −1: it has not this one), or a
/// single channel; a single alpha four times. Of several that are called so, or whose names end so, the nearest to the
/// colours. Nothing: there is none, or none that is nearest.
std::optional<ChannelChoice> find_layer(const std::vector<FilePart>& parts, const std::string& name,
                                        BesideColor beside = {});

/// "ViewLayer.Depth.Z", "ViewLayer.Normal.XYZ"; of files with several parts behind the name of its part.
std::string choice_text(const std::vector<FilePart>& parts, const ChannelChoice& choice);
/// What options call it: a single channel as above, several by their layer. Empty: they have no name.
std::string choice_name(const std::vector<FilePart>& parts, const ChannelChoice& choice);

/// What options may call channels that are, or look like, "depth", "normal" or "motion", of whatever layer and eye;
/// surer ones first.
std::vector<std::string> likely_names(const std::vector<FilePart>& parts, const std::string& kind);

/// The names that `find_layer` knows, without those of single channels.
std::vector<std::string> layer_names(const std::vector<FilePart>& parts);

}  // namespace afterglow
