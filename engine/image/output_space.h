// SPDX-License-Identifier: MIT
// Scene-linear light to the values that a colour space stores: the way back of input_space.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "image/color_matrix.h"
#include "image/input_space.h"

namespace afterglow {

/// Immutable, thread-safe. The curve is the inverse of InputSpace::to_linear, by a table over the floats whose lines
/// are off by less than 2e-6 of the whole.
class OutputSpace {
 public:
  /// Made at the first call for each space, kept for the life of the process.
  static const OutputSpace& of(const InputSpace& space);

  const char* name() const { return name_; }
  bool of_display() const { return of_display_; }  ///< see InputSpace
  bool linear() const { return linear_; }
  const Chromaticities& primaries() const { return primaries_; }
  /// Colours of RGBA pixels, linear Rec.709, become stored values 0…1; alpha stays. Light beyond what the space holds
  /// is held at its ends, which may lie below 0, NaN at that of 0. `stored` may be `rgba` itself.
  void encode(const float* rgba, std::size_t pixels, float* stored) const;
  /// The same, but light beyond the ends keeps stored values below 0 and above 1, −2…3 at the most, as readers of YUV
  /// take them. `stored` is not `rgba`.
  void encode_beyond(const float* rgba, std::size_t pixels, float* stored) const;
  /// Colours as of `encode`, bit for bit, of half floats; what stands at the place of alpha has no meaning.
  void encode_colors(const std::uint16_t* rgba, std::size_t pixels, float* stored) const;

 private:
  explicit OutputSpace(const InputSpace& space);
  float stored_value(float light) const;
  float stored_below(float light) const;
  std::size_t encode_pairs(const float* rgba, std::size_t pixels, float* stored) const;
  float beyond(float light) const;
  void to_own(float* rgb) const;

  const char* name_;
  bool of_display_, linear_, hlg_display_;
  Chromaticities primaries_;
  std::optional<Matrix3> matrix_;  ///< from Rec.709, when the primaries are others
  float of_zero_ = 0;              ///< what light 0 is stored as
  std::vector<float> table_;       ///< stored values at the ends of equal parts of octaves
  /// Logarithms of film and cameras have codes for light below 0: what those from `darkest_` to 0 are stored as.
  float darkest_ = 0;
  std::vector<float> below_;
  /// What stored values from −2 to 3 mean, in equal steps, as far as the curve rises there. Made when it is first asked
  /// for.
  const std::vector<double>& wide() const;
  double (*to_linear_)(double);
  mutable std::once_flag wide_made_;
  mutable std::vector<double> wide_;
  mutable double wide_from_ = 0;
  /// Stored values of all half floats, by their bits. Made when they are first asked for.
  const std::vector<float>& of_halves() const;
  mutable std::once_flag halves_made_;
  mutable std::vector<float> of_halves_;
};

/// Primaries and transfer of a space by ITU-T H.273; 2 where there is no number.
struct SpaceCodes {
  int primaries = 2, transfer = 2;
};
SpaceCodes space_codes(const OutputSpace& space);
/// Of displays, but not like sRGB: what takes its codes for sRGB shows other colours (P3, Adobe RGB, PQ, HLG).
bool must_be_told(const OutputSpace& space);

/// The space of this name, for outputs. Empty: none is asked for, null. Errors (usage): unknown.
Result<const OutputSpace*> find_output_space(const std::string& name);

}  // namespace afterglow
