// SPDX-License-Identifier: MIT
// A linear resampling described as data. What a `filter` pass does; the executor chooses how.
#pragma once

#include <string>
#include <vector>

namespace afterglow {

/// How the source is read between texel centres (math.md §1): the nearest texel, the two nearest (bilinear), or the
/// four of the cubic B-spline (which blurs).
enum class Interpolation { nearest, linear, cubic_bspline };

/// What lies beyond the edges of the source: its edge texels, or the picture mirrored there, again and again.
enum class Edges { stretch, mirror };

struct Tap {
  double offset = 0;  ///< texels of the source
  double weight = 1;
  friend bool operator==(const Tap&, const Tap&) = default;
};

struct Tap2d {
  double dx = 0, dy = 0;  ///< texels of the source
  double weight = 1;
  friend bool operator==(const Tap2d&, const Tap2d&) = default;
};

/// out(X, Y) = Σ weight · I(px + dx, py + dy), where px = (X + ½)·n_src/n_dst in texels (a texel centre is at i + ½), I
/// is the source under `interpolation` with its `edges`. The taps are the outer product of `x` and `y`, or `taps` when
/// that is not empty. Weights are used as given, never renormalised.
struct Filter {
  Interpolation interpolation = Interpolation::linear;
  std::vector<Tap> x{Tap{}};
  std::vector<Tap> y{Tap{}};
  std::vector<Tap2d> taps{};
  Edges edges = Edges::stretch;
  friend bool operator==(const Filter&, const Filter&) = default;

  bool separable() const { return taps.empty(); }
  /// A one-line text that is equal exactly when two filters are equal; part of cache keys and of `graph` output.
  std::string text() const;
};

}  // namespace afterglow
