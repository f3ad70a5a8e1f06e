// SPDX-License-Identifier: MIT
#include "reference/cut.h"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/vec2.hpp>

#include "reference/color.h"
#include "reference/grain.h"

namespace afterglow::reference {
namespace {

/// Where an angle points, in pixels; quarters of a turn to the last digit.
glm::dvec2 direction(double degrees) {
  const double quarters = degrees / 90, angle = degrees * glm::pi<double>() / 180;
  if (quarters != std::floor(quarters)) return {std::cos(angle), -std::sin(angle)};
  const glm::dvec2 ways[] = {{1, 0}, {0, -1}, {-1, 0}, {0, 1}};
  return ways[(static_cast<int>(quarters) % 4 + 4) % 4];
}

double share_of(double x) { return x - std::floor(x); }

/// When the turn of the point (u, v) comes; 0 … 1.
double turn_at(int x, int y, Size size, const Cut& s) {
  const double aspect = static_cast<double>(size.width) / size.height, angle = s.angle * glm::pi<double>() / 180;
  const double u = (x + 0.5) / size.width, v = (y + 0.5) / size.height;
  const double dx = (u - s.center_x) * aspect, dy = v - s.center_y;
  if (s.kind == CutKind::iris) {
    const double far_x = glm::max(s.center_x, 1 - s.center_x) * aspect, far_y = glm::max(s.center_y, 1 - s.center_y);
    return std::hypot(dx, dy) / std::hypot(far_x, far_y);
  }
  if (s.kind == CutKind::clock && dx == 0 && dy == 0) return 0;
  if (s.kind == CutKind::clock) return share_of((angle - std::atan2(-dy, dx)) / glm::two_pi<double>());
  if (s.kind == CutKind::scatter) {
    const auto cell = [&](int at) { return static_cast<std::uint32_t>(std::floor((at + 0.5) / s.grain)); };
    return unit(pcg3d({cell(x), cell(y), s.seed})[0]);
  }
  const glm::dvec2 to = direction(s.angle);
  const double way = std::abs(to.x) * aspect + std::abs(to.y);
  const double along = ((u - 0.5) * aspect * to.x + (v - 0.5) * to.y) / way + 0.5;
  return s.kind == CutKind::blinds ? share_of(along * s.count) : along;
}

}  // namespace

DoubleImage transition(const DoubleImage& source, const DoubleImage* other, const Cut& s) {
  const Size size = source.size();
  const glm::dvec2 to = direction(s.angle);
  const bool level = std::abs(to.x) >= std::abs(to.y);
  const int way_x = level ? (to.x > 0 ? 1 : -1) : 0, way_y = level ? 0 : (to.y > 0 ? 1 : -1);
  return generate(size, [&](int x, int y) {
    const Rgba& p = source.at(x, y);
    const Rgb plain = glm::min(s.color * p.a, Rgb(kMostLight));
    const auto next = [&](int px, int py) { return other ? Rgb(other->clamped(px, py)) : plain; };
    Rgb out;
    if (s.kind == CutKind::dissolve) {
      out = glm::mix(Rgb(p), next(x, y), s.progress);
    } else if (s.kind == CutKind::fade) {
      out =
          s.progress < 0.5 ? glm::mix(Rgb(p), plain, 2 * s.progress) : glm::mix(plain, next(x, y), 2 * s.progress - 1);
    } else if (s.kind == CutKind::push) {
      const int px = x - static_cast<int>(std::floor(way_x * size.width * s.progress + 0.5));
      const int py = y - static_cast<int>(std::floor(way_y * size.height * s.progress + 0.5));
      const bool stays = px >= 0 && py >= 0 && px < size.width && py < size.height;
      out = stays ? Rgb(source.at(px, py)) : next(px + way_x * size.width, py + way_y * size.height);
    } else {
      const double soft = glm::max(s.softness, 1e-4);
      out =
          glm::mix(Rgb(p), next(x, y), glm::clamp((s.progress * (1 + soft) - turn_at(x, y, size, s)) / soft, 0.0, 1.0));
    }
    return Rgba(out, p.a);
  });
}

}  // namespace afterglow::reference
