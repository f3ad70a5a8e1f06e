// SPDX-License-Identifier: MIT
#include "script/volume_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace afterglow::script {
namespace {

Position minus(const Position& a, const Position& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

// Turns (a, b), two coordinates of a point, by −degrees in their plane.
void turn_back(double& a, double& b, double degrees) {
  if (degrees == 0) return;  // boxes along the axes stay exact
  const double angle = degrees * std::numbers::pi / 180;
  const double c = std::cos(angle), s = std::sin(angle);
  const double turned = c * a + s * b;
  b = c * b - s * a;
  a = turned;
}

}  // namespace

double VolumeShape::distance_to(const Position& point) const {
  if (kind == ShapeKind::global) return 0;
  Position p = minus(point, center);
  if (kind == ShapeKind::sphere) return std::max(0.0, std::hypot(p[0], p[1], p[2]) - radius);
  // Into the box's own axes: the rotation Ry·Rx·Rz undone from the left.
  turn_back(p[2], p[0], rotation[1]);
  turn_back(p[1], p[2], rotation[0]);
  turn_back(p[0], p[1], rotation[2]);
  for (std::size_t i = 0; i < 3; ++i) p[i] = std::max(0.0, std::abs(p[i]) - size[i] / 2);
  return std::hypot(p[0], p[1], p[2]);
}

double volume_factor(double weight, double distance, double blend_distance) {
  const double whole = std::clamp(weight, 0.0, 1.0);
  if (distance <= 0) return whole;
  if (distance >= blend_distance) return 0;
  const double share = distance / blend_distance;
  return whole * (1 - share * share);
}

}  // namespace afterglow::script
