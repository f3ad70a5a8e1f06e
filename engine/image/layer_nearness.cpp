// SPDX-License-Identifier: MIT
#include "image/layer_nearness.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include "core/text.h"

namespace afterglow {
namespace {

using Path = std::vector<std::string>;

bool is_picture(const ChannelLayer& l) { return has_rgb(l) && color_rank(l) >= 0; }

/// The path of the picture that a layer is part of: "ViewLayer" of "ViewLayer.Depth", "fg" of a "fg.Z" beside "fg.R".
Path owner_of(const ChannelLayer& l) {
  if (is_picture(l) || l.path.empty()) return l.path;
  return {l.path.begin(), l.path.end() - 1};
}

int shared(const Path& a, const Path& b) {
  const auto end = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return static_cast<int>(end.first - a.begin());
}

/// How likely a part holds a picture of its own, as `color_rank`; negative: it holds none.
int part_rank(const std::vector<ChannelLayer>& layers, int part) {
  int best = -1;
  for (const ChannelLayer& l : layers) {
    if (l.part != part || !is_picture(l)) continue;
    const int rank = color_rank(l);
    if ((l.prefix.empty() || rank <= kMainPicture) && (best < 0 || rank < best)) best = rank;
  }
  return best;
}

/// Whether "aov" of "aov.depth.Z" is a layer that has a picture, "aov.beauty" or "aov" itself.
bool has_picture(const std::vector<ChannelLayer>& layers, const Path& owner) {
  return std::ranges::any_of(layers, [&](const ChannelLayer& l) {
    if (!is_picture(l) || l.path.empty() || l.path.front() != owner.front()) return false;
    return color_rank(l) <= kMainPicture || l.path == owner;
  });
}

bool of_other_part(const ChannelLayer& l, const ChannelLayer& own, const std::vector<ChannelLayer>& layers) {
  if (l.part == own.part) return false;
  const int rank = part_rank(layers, l.part);
  if (rank < 0) return false;
  return rank > kMainPicture || color_rank(own) <= kMainPicture;
}

bool is_composite(const ChannelLayer& own) { return !own.path.empty() && lower(own.path.front()) == "composite"; }

}  // namespace

std::optional<Nearness> nearness(const ChannelLayer& l, const Beside& beside) {
  if (!beside.own) return Nearness{.apart = static_cast<int>(owner_of(l).size())};
  const ChannelLayer& own = *beside.own;
  if (!beside.other_file && &l == &own) return Nearness{.kind = Nearness::Kind::own};
  if (!l.view.empty() && lower(l.view) != lower(own.view) && !(beside.other_file && own.view.empty()))
    return std::nullopt;
  Path owner = owner_of(l);
  // What stands with the picture itself, "rgba.Z", is that of its passes, too.
  const bool main = owner.size() == 1 && is_picture(l) && color_rank(l) <= kMainPicture;
  if (main && color_rank(own) > kMainPicture) owner.clear();
  const int common = shared(own.path, owner);
  Nearness near{.apart = static_cast<int>(own.path.size() + owner.size()) - 2 * common,
                .other_part = !beside.other_file && l.part != own.part,
                .every_eye = l.view.empty() != own.view.empty()};
  const bool alien = !beside.other_file && of_other_part(l, own, *beside.layers);
  if (alien) return std::nullopt;
  if (common > 0) {
    near.kind = Nearness::Kind::related;
  } else if (owner.empty()) {
    near.kind = Nearness::Kind::common;
    near.apart = 0;
  } else {
    const bool of_all = own.path.size() <= 1 && color_rank(own) <= kMainPicture;
    if (!beside.other_file && !is_composite(own) && !(of_all && !has_picture(*beside.layers, owner)))
      return std::nullopt;
    near.kind = Nearness::Kind::only;
    near.apart = 0;
  }
  return near;
}

std::optional<ChannelChoice> nearest(const std::vector<const ChannelLayer*>& layers, const Beside& beside,
                                     const Offer& offer, bool (*unsure)(const ChannelLayer&)) {
  struct Candidate {
    std::tuple<Nearness, bool> place;
    const ChannelLayer* layer;
    std::vector<int> channels;
  };
  std::vector<Candidate> found;
  for (const ChannelLayer* layer : layers) {
    const auto near = nearness(*layer, beside);
    auto channels = near ? offer(*layer) : std::nullopt;
    if (channels) found.push_back({{*near, unsure && unsure(*layer)}, layer, std::move(*channels)});
  }
  const auto best = std::ranges::min_element(found, {}, &Candidate::place);
  if (best == found.end()) return std::nullopt;
  ChannelChoice choice{.part = best->layer->part, .channels = best->channels};
  for (const Candidate& other : found)
    if (other.layer != best->layer && other.place == best->place)
      choice.equal.push_back({.part = other.layer->part, .channels = other.channels});
  return choice;
}

}  // namespace afterglow
