// SPDX-License-Identifier: MIT
// How the colour samples of a file are encoded, and how they become scene-linear Rec.709.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/color_matrix.h"
#include "image/picture.h"

namespace afterglow {

/// A profile that is no matrix and curves; wraps a transform of Little CMS. Thread-safe.
class ProfileTransform {
 public:
  virtual ~ProfileTransform() = default;
  /// RGB triples, in place.
  virtual void apply(float* rgb, std::size_t pixels) const = 0;
};

enum class TransferCurve { linear, srgb, rec709, power, tables, formula };
enum class AlphaKind { none, associated, straight };

struct ColorEncoding {
  TransferCurve curve = TransferCurve::linear;
  double exponent = 1;                         ///< of `power`
  double (*formula)(double) = nullptr;         ///< of `formula`: stored value to light
  std::array<std::vector<float>, 3> tables{};  ///< of `tables`: linear values for equally spaced stored values 0…1
  bool hlg_display = false;                    ///< behind the curve goes hlg_to_display (hlg_rendering.h)
  std::optional<Matrix3> matrix;               ///< to Rec.709, when the primaries are others
  double gain = 1;  ///< light of the scene ÷ light that is stored, whatever curve and matrix
  std::shared_ptr<const ProfileTransform> transform;  ///< replaces curve and matrix
  AlphaKind alpha = AlphaKind::none;
  int max_code = 0;  ///< 255 or 65535 for integers of that many codes; 0: any value
  /// Stored values lie anywhere between codes, most of them in −0.25…1.25: curves are taken from a fine table there.
  bool dense = false;
  bool keep_negative = false;  ///< colours below 0 stay, if they are finite
  bool data = false;           ///< no colours: values stay as they are stored, if they are finite
  bool grey = false;           ///< only the first sample of a pixel was read; it stands for all three
};

/// Brings rows of RGBA that hold stored values (integers scaled to 0…1) into the form that Picture::color has. `pixels`
/// are contiguous. Counts what had to be made finite.
void decode_color(const ColorEncoding& encoding, float* rgba, std::size_t pixels, SanitizeCounts& counts);
/// The same for a whole image, on several threads. `found`: what of the stored values was not finite, added up.
void decode_color(const ColorEncoding& encoding, Image& rgba, SanitizeCounts& counts, NonFinite* found = nullptr);
/// The same for rows [begin, end) of an image at a time, from several threads. What it was given has to outlive it.
std::function<void(int begin, int end)> decoder_of_rows(const ColorEncoding& encoding, Image& rgba,
                                                        SanitizeCounts& counts, NonFinite* found);

void sanitize_depth(Image& depth, SanitizeCounts& counts);
void sanitize_normal(Image& normal, SanitizeCounts& counts);

}  // namespace afterglow
