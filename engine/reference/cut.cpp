// SPDX-License-Identifier: MIT
#include "reference/cut.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/vec2.hpp>
#include <limits>

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

/// When a pixel's turn comes, 0 … 1; how wide a pixel is in turns; how many pixels it is from where the turns begin
/// again.
struct Turn {
  double at = 0, pixel = 1e-4, from_seam = std::numeric_limits<double>::infinity();
};

Turn clock_turn(glm::dvec2 from, const Cut& s) {
  const double distance = glm::length(from);
  if (distance == 0) return {0, 1, 0};
  const double behind = s.angle * glm::pi<double>() / 180 - std::atan2(-from.y, from.x);
  const double seam = std::cos(behind) >= 0 ? distance * std::abs(std::sin(behind)) : 1;
  return {share_of(behind / glm::two_pi<double>()), glm::min(1 / (glm::two_pi<double>() * distance), 1.0), seam};
}

Turn turn_at(int x, int y, Size size, const Cut& s) {
  const glm::dvec2 pixels(size.width, size.height), here(x + 0.5, y + 0.5), center(s.center_x, s.center_y);
  const glm::dvec2 from = here - center * pixels;
  if (s.kind == CutKind::clock) return clock_turn(from, s);
  if (s.kind == CutKind::iris) {
    const double farthest = glm::length(glm::max(center, 1.0 - center) * pixels);
    return {glm::length(from) / farthest, glm::min(1 / farthest, 1.0)};
  }
  if (s.kind == CutKind::scatter) {
    const auto cell = [&](double at) { return static_cast<std::uint32_t>(std::floor(at / s.grain)); };
    return {unit(pcg3d({cell(here.x), cell(here.y), s.seed})[0])};
  }
  const glm::dvec2 to = direction(s.angle);
  const double way = glm::dot(glm::abs(to), pixels), along = glm::dot(here - 0.5 * pixels, to) / way + 0.5;
  if (s.kind == CutKind::wipe) return {along, glm::min(1 / way, 1.0)};
  const double strip = share_of(along * s.count), pixel = glm::min(s.count / way, 1.0);
  return {strip, pixel, glm::min(strip, 1 - strip) / pixel};
}

/// How much of the other picture is seen.
double gone_at(const Turn& turn, const Cut& s) {
  const double edge = glm::max(s.softness, turn.pixel);
  const auto gone = [&](double at) { return glm::clamp((s.progress * (1 + edge) - at) / edge, 0.0, 1.0); };
  if (turn.from_seam >= 0.5) return gone(turn.at);
  return glm::mix(gone(turn.at < 0.5 ? 1 : 0), gone(turn.at), 0.5 + turn.from_seam);
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
      out = glm::mix(Rgb(p), next(x, y), gone_at(turn_at(x, y, size, s), s));
    }
    return Rgba(out, p.a);
  });
}

}  // namespace afterglow::reference
