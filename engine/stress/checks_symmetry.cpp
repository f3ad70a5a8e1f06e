// SPDX-License-Identifier: MIT
// Promises about where things are: mirrored, turned and moved pictures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "stress/check.h"

namespace afterglow::stress {
namespace {

/// Pixel (x, y) of the new image is pixel `from(x, y)` of the old one.
struct Place {
  int x, y;
};
using Map = std::function<Place(int x, int y)>;

Image mapped(const Image& image, Size size, const Map& from) {
  Image out(size.width, size.height, image.channels);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const Place p = from(x, y);
      std::copy_n(image.at(p.x, p.y), image.channels, out.at(x, y));
    }
  return out;
}

Picture mapped(const Picture& picture, Size size, const Map& from) {
  Picture out = changed(picture);
  out.color = mapped(picture.color, size, from);
  for (auto& [name, image] : out.auxiliary) image = mapped(image, size, from);
  out.data_window = out.display_window = {0, 0, size.width, size.height};
  return out;
}

/// The result of the mapped picture against the mapped result.
Result<Outcome> commutes(Harness& harness, const Situation& s, const Picture& picture, Size size, const Map& from,
                         double allowed, const std::string& what) {
  AFTERGLOW_TRY(const Made straight, harness.run(s.look, picture, s.frame, usual_way(harness)));
  AFTERGLOW_TRY(const Made turned, harness.run(s.look, mapped(picture, size, from), s.frame, usual_way(harness)));
  return compare(turned.image, mapped(straight.image, size, from), allowed, what);
}

Result<Outcome> mirror(Harness& harness, const Situation& s, const Invariant& hold) {
  const Size size = s.picture.color.size();
  const double allowed = hold.numbers.at("within");
  AFTERGLOW_TRY(const Outcome across, commutes(
                                          harness, s, s.picture, size,
                                          [&](int x, int y) {
                                            return Place{size.width - 1 - x, y};
                                          },
                                          allowed, "mirrored, left and right"));
  if (!across.holds) return across;
  return commutes(
      harness, s, s.picture, size,
      [&](int x, int y) {
        return Place{x, size.height - 1 - y};
      },
      allowed, "mirrored, top and bottom");
}

Result<Outcome> turn_180(Harness& harness, const Situation& s, const Invariant& hold) {
  const Size size = s.picture.color.size();
  return commutes(
      harness, s, s.picture, size,
      [&](int x, int y) {
        return Place{size.width - 1 - x, size.height - 1 - y};
      },
      hold.numbers.at("within"), "turned by 180 degrees");
}

/// The picture with black wherever `inside` is false.
Picture masked(const Picture& picture, const std::function<bool(int x, int y)>& inside) {
  Picture out = changed(picture);
  for (int y = 0; y < out.color.height; ++y)
    for (int x = 0; x < out.color.width; ++x)
      if (!inside(x, y)) std::fill_n(out.color.at(x, y), 3, 0.0f);
  return out;
}

Result<Outcome> turn_90(Harness& harness, const Situation& s, const Invariant& hold) {
  const Size size = s.picture.color.size(), turned{size.height, size.width};
  const auto m = static_cast<int>(std::min(hold.numbers.at("margin"), 1e6));
  if (2 * m >= size.width || 2 * m >= size.height) return not_applicable();
  const Picture picture =
      masked(s.picture, [&](int x, int y) { return x >= m && y >= m && x < size.width - m && y < size.height - m; });
  return commutes(
      harness, s, picture, turned,
      [&](int x, int y) {
        return Place{y, size.height - 1 - x};
      },
      hold.numbers.at("within"), "turned by 90 degrees");
}

/// Moved to the right and down. Light stays `margin` away from all edges before and after.
Result<Outcome> shift(Harness& harness, const Situation& s, const Invariant& hold) {
  const Size size = s.picture.color.size();
  const double by = hold.numbers.at("by"), margin = hold.numbers.at("margin");
  if (!(by >= 1) || by + 2 * margin >= std::max(size.width, size.height)) return not_applicable();
  const int step = static_cast<int>(by), m = static_cast<int>(margin);
  const auto steps_along = [&](int length) { return std::max(0, (length - 2 * m - 1) / step); };
  Random random(s.seed);
  const int dx = step * static_cast<int>(random.below(static_cast<std::size_t>(steps_along(size.width)) + 1));
  const int dy = step * static_cast<int>(random.below(static_cast<std::size_t>(steps_along(size.height)) + 1));
  const Rect light{m, m, size.width - 2 * m - dx, size.height - 2 * m - dy};
  if ((dx == 0 && dy == 0) || light.width <= 0 || light.height <= 0) return not_applicable();
  const Picture before = masked(s.picture, [&](int x, int y) {
    return x >= light.x && y >= light.y && x < light.x + light.width && y < light.y + light.height;
  });
  // Pixels that come in from outside are black, as those at the edge are; auxiliary images move along.
  const Picture after = mapped(before, size, [&](int x, int y) {
    return Place{std::max(x - dx, 0), std::max(y - dy, 0)};
  });
  AFTERGLOW_TRY(const Made a, harness.run(s.look, before, s.frame, usual_way(harness)));
  AFTERGLOW_TRY(const Made b, harness.run(s.look, after, s.frame, usual_way(harness)));
  const Size common{size.width - dx, size.height - dy};
  return compare(mapped(b.image, common,
                        [&](int x, int y) {
                          return Place{x + dx, y + dy};
                        }),
                 mapped(a.image, common,
                        [](int x, int y) {
                          return Place{x, y};
                        }),
                 hold.numbers.at("within"), fmt::format("moved by {} and {} pixels", dx, dy));
}

constexpr Check kSymmetryChecks[] = {
    {"mirror", "mirror", "mirrored pictures give mirrored results", mirror},
    {"turn_180", "turn_180", "turned pictures give turned results", turn_180},
    {"turn_90", "turn_90", "the same for 90 degrees", turn_90},
    {"shift", "shift", "moved pictures give moved results", shift},
};

}  // namespace

std::span<const Check> symmetry_checks() { return kSymmetryChecks; }

}  // namespace afterglow::stress
