// How a filter reads along one axis: which texels, with which weights, as GLSL. Internal to the room.
//
// The point of a tap lies at p + offset, p = (x + ½)·n_src/n_dst; t = p − ½ + offset, texel i = ⌊t⌋, fraction f = t −
// i, g = 1 − f. Where the ratio fixes f (same, half) weights are numbers; else they are made of f and g, found exactly
// from integers (twice: by parity; any: ag_phase of the prelude). Taps whose offsets differ by whole texels share f ("a
// class").
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

/// One filtered fetch's share of a tap: at `position` (an expression, in texels) with weight constant · variable.
struct FetchTerm {
  std::string position;
  double constant = 1;
  std::string variable;
};

class Axis {
 public:
  /// `letter`: 'x' or 'y'.
  Axis(char letter, AxisRatio ratio, Interpolation interpolation);

  /// Weights are plain numbers.
  bool fixed() const { return ratio_ == AxisRatio::same || ratio_ == AxisRatio::half; }

  /// The texels that a tap of weight 1 reads.
  std::vector<TapTerm> read(double offset);
  /// The same through the sampler's interpolation. Not for Interpolation::nearest.
  std::vector<FetchTerm> fetch(double offset);
  /// For a fixed axis: filtered fetches for merged texels, neighbours in pairs.
  std::vector<FetchTerm> fetch_pairs(const std::map<TexelKey, double>& texels) const;

  /// Statements that declare what the expressions use. Call after the last read or fetch.
  std::string setup() const;
  /// Expression: index of a texel, clamped to the image where it could leave it.
  std::string index(TexelKey texel) const;

 private:
  int phase_for(double fraction);
  std::string name(const char* what, int phase) const;  ///< "ag_xf0"
  std::string base(int phase) const;

  char letter_;
  AxisRatio ratio_;
  Interpolation interpolation_;
  std::vector<double> fractions_;  ///< of each class, in [0, 1)
};

/// A float as GLSL writes it, with all its digits.
std::string float_literal(double value);
/// "constant * variable", without factors that are 1.
std::string product(double constant, const std::string& variable);

}  // namespace afterglow
