// SPDX-License-Identifier: MIT
#include "image/exr_primaries.h"

#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>

#include "core/parallel.h"
#include "image/encode.h"
#include "image/metadata.h"

namespace afterglow {
namespace {

Imath::V2f point(const std::array<double, 2>& xy) { return {static_cast<float>(xy[0]), static_cast<float>(xy[1])}; }

}  // namespace

Chromaticities chromaticities_of(const Imf::Header& header) {
  if (!Imf::hasChromaticities(header)) return kRec709;
  const Imf::Chromaticities& stored = Imf::chromaticities(header);
  const auto xy = [](const Imath::V2f& v) { return std::array<double, 2>{v.x, v.y}; };
  return {xy(stored.red), xy(stored.green), xy(stored.blue), xy(stored.white)};
}

std::optional<Chromaticities> own_primaries(const Imf::Header& header) {
  constexpr double kRounded = 2e-3;
  const Chromaticities primaries = chromaticities_of(header);
  const Matrix3 matrix = to_rec709(primaries);
  if (matrix == Matrix3{} || nearly_equal(matrix, kIdentity, kRounded)) return std::nullopt;
  return primaries;
}

Imf::Chromaticities exr_chromaticities(const Chromaticities& primaries) {
  return {point(primaries.red), point(primaries.green), point(primaries.blue), point(primaries.white)};
}

std::optional<Chromaticities> written_primaries(const Picture& picture, const WriteOptions& options) {
  if (options.space)
    return options.space->primaries() == kRec709 ? std::nullopt : std::optional(options.space->primaries());
  return options.keep_layers && picture.facts ? picture.facts->primaries : std::nullopt;
}

Picture in_primaries(const Picture& picture, const Chromaticities& primaries) {
  const Matrix3 m = inverse(to_rec709(primaries));
  Picture out;
  out.color = Image(picture.color.width, picture.color.height, 4);
  out.has_alpha = picture.has_alpha;
  out.data_window = picture.data_window;
  out.display_window = picture.display_window;
  out.facts = picture.facts;
  const int width = out.color.width, height = out.color.height;
  parallel_rows(height, static_cast<long long>(width) * height * 4, [&](int begin, int end) {
    std::vector<float> memory;
    for (int y = begin; y < end; ++y) {
      const float* from = color_row(picture, y, memory);
      float* to = out.color.at(0, y);
      for (int x = 0; x < width; ++x, from += 4, to += 4) {
        multiply(m, from, to);
        to[3] = from[3];
      }
    }
  });
  return out;
}

}  // namespace afterglow
