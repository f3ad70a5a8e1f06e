// SPDX-License-Identifier: MIT
// Which layers stand how near to the colours that were chosen: depth, normals and the like of another view layer or eye
// belong to another picture. Used by layers.cpp alone.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "image/channel_layers.h"

namespace afterglow {

/// The colours that things are looked for beside. Refers to what it was made of.
struct Beside {
  const std::vector<ChannelLayer>* layers = nullptr;  ///< those of the colours' file
  const ChannelLayer* own = nullptr;                  ///< the colours' own; null: not known, all are as near
  bool other_file = false;  ///< a file that was named is looked through: nothing in it is another picture's
};

/// Smaller is nearer; equal ones are equally near.
struct Nearness {
  /// Its own layer; its view layer's; what belongs to no layer; the only one that a picture of all layers may mean.
  enum class Kind { own, related, common, only } kind = Kind::common;
  int apart = 0;  ///< leading components of their names that are not shared
  bool other_part = false, every_eye = false;

  auto operator<=>(const Nearness&) const = default;
};
/// Nothing: it belongs to another layer or eye.
std::optional<Nearness> nearness(const ChannelLayer& layer, const Beside& beside);

/// The channels that a layer offers, as index into the channels of its part; nothing: none.
using Offer = std::function<std::optional<std::vector<int>>(const ChannelLayer&)>;
/// The nearest of `layers` that offers channels, with the names of others as near (`ChannelChoice::equal`). Of those as
/// near the ones that are not `unsure` come first, then the file's order.
std::optional<ChannelChoice> nearest(const std::vector<const ChannelLayer*>& layers, const Beside& beside,
                                     const Offer& offer, bool (*unsure)(const ChannelLayer&) = nullptr);

}  // namespace afterglow
