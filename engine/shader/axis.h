// SPDX-License-Identifier: MIT
// How a filter reads along one axis: which texels, with which weights, as GLSL. Internal to the room.
//
// The point of a tap lies at p + offset, p = (x + ½)·n_src/n_dst; t = p − ½ + offset, texel i = ⌊t⌋, fraction f = t −
// i, g = 1 − f. Where the ratio fixes f (same, half; enlarging, when an invocation makes whole periods of 2 or 4
// pixels) weights are numbers; else they are made of f and g, found exactly from integers (enlarging: by the pixel's
// place in its period; any: ag_phase of the prelude). Taps whose offsets differ by whole texels share f ("a class").
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/filter.h"
#include "shader/kernel.h"

namespace afterglow {

/// A texel: its class and its distance from the class's base texel.
struct TexelKey {
  int phase = 0;  ///< index of the class
  int shift = 0;
  friend auto operator<=>(const TexelKey&, const TexelKey&) = default;
};

/// One texel's share of a tap: constant · variable (an expression; "" is 1).
struct TapTerm {
  TexelKey texel;
  double constant = 1;
  std::string variable;
};

/// One texel's share of a tap, for each place of a pixel in its period.
struct PlacedTerm {
  TexelKey texel;
  std::vector<double> by_place;
};

/// One filtered fetch's share of a tap: at `position` (an expression, in texels) with weight constant · variable.
struct FetchTerm {
  std::string position;
  double constant = 1;
  std::string variable;
};

class Axis {
 public:
  /// `letter`: 'x' or 'y'. `pixels`: how many target pixels an invocation makes along this axis, from ag_pixel on.
  Axis(char letter, AxisRatio ratio, const Filter& filter, int pixels = 1);

  /// Weights are plain numbers.
  bool fixed() const { return ratio_ != AxisRatio::any && pixels_ % period() == 0; }

  /// The texels that a tap of weight 1 reads for one of the invocation's pixels (other than the first: fixed axes
  /// only).
  std::vector<TapTerm> read(double offset, int pixel = 0);
  /// Weights of texels depend on the pixel's place alone, which repeats: they can be read by `read_placed`.
  bool placed() const { return !fixed() && period() > 1; }
  /// The same for such an axis: all taps count texels from one base, so that those which several of them read are one.
  std::vector<PlacedTerm> read_placed(double offset);
  /// Expression: the weight at the pixel's place.
  std::string weight(const std::vector<double>& by_place) const;
  /// The same through the sampler's interpolation. Not for Interpolation::nearest.
  std::vector<FetchTerm> fetch(double offset);
  /// For a fixed axis: filtered fetches for merged texels, neighbours in pairs.
  std::vector<FetchTerm> fetch_pairs(const std::map<TexelKey, double>& texels) const;

  /// Statements that declare what the expressions use. Call after the last read or fetch.
  std::string setup() const;
  /// Expression: index of a texel, brought back into the image where it could leave it.
  std::string index(TexelKey texel) const;

 private:
  /// Target pixels after which f repeats; 1 for ratios that do not enlarge.
  int period() const { return ratio_ == AxisRatio::twice ? 2 : ratio_ == AxisRatio::fourfold ? 4 : 1; }
  /// Texels a target pixel; not for `any`.
  double step() const { return ratio_ == AxisRatio::half ? 2.0 : 1.0 / period(); }
  int phase_for(double fraction);
  /// An expression for the value of the pixel's place in its period.
  std::string by_place(const std::vector<std::string>& values) const;
  std::string name(const char* what, int phase) const;  ///< "ag_xf0"
  std::string base(int phase) const;
  /// Expression: a position that the sampler may take.
  std::string inside(const std::string& position) const;

  char letter_;
  AxisRatio ratio_;
  Interpolation interpolation_;
  Edges edges_;
  int pixels_;
  std::vector<double> fractions_;  ///< of each class, in [0, 1)
};

/// A float as GLSL writes it, with all its digits.
std::string float_literal(double value);
/// "constant * variable", without factors that are 1.
std::string product(double constant, const std::string& variable);

}  // namespace afterglow
