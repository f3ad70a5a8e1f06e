// SPDX-License-Identifier: MIT
#include "image/strips.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "core/parallel.h"
#include "image/encode.h"
#include "image/output_format.h"

namespace afterglow {

/// Alpha in three samples a word is what OpenImageIO 2.4 writes wrongly (DPX, 10 bits).
StripForm strip_form(const Picture& picture, const OutputFormat& format, const WriteOptions& options) {
  const SampleType type = sample_type(format, options, picture.facts.get());
  return {type,
          picture.has_alpha && format.alpha && !(type == SampleType::uint10),
          dithers(options, type),
          options.dither_x,
          options.dither_y,
          picture.view && !options.space ? nullptr : stored_space(format, options, type),
          picture.view};
}

void encode_rows(const Picture& picture, const StripForm& form, int first, int rows, std::uint8_t* bytes) {
  const auto width = static_cast<std::size_t>(picture.display_window.width),
             channels = std::size_t{form.alpha ? 4u : 3u};
  const float padding = picture.has_alpha ? 0.0f : 1.0f;
  const CodeRules rules{max_code(form.type), form.alpha, form.dither, form.space};
  if (form.type == SampleType::uint8 && !picture.unorm8.empty()) {
    std::vector<std::uint8_t> row(width * 4);
    for (int i = 0; i < rows; ++i) {
      display_row(picture, first + i, static_cast<std::uint8_t>(padding * 255), row.data());
      if (channels == 4) {
        std::copy_n(row.data(), width * 4, bytes);
      } else {  // four bytes at a time, of which the next ones cover the last
        for (std::size_t x = 0; x + 1 < width; ++x) std::memcpy(bytes + 3 * x, &row[x * 4], 4);
        std::copy_n(&row[width * 4 - 4], 3, bytes + 3 * (width - 1));
      }
      bytes += width * channels;
    }
    return;
  }
  const bool integers = is_integer(form.type);
  std::vector<float> rgba(width * 4), packed(integers ? 0 : width * channels);
  for (int i = 0; i < rows; ++i, bytes += form.row_bytes(picture)) {
    display_row(picture, first + i, padding, rgba.data());
    if (form.type == SampleType::uint8) {
      encode_row(rules, rgba.data(), static_cast<int>(width), form.dither_x, form.dither_y + first + i, bytes);
    } else if (integers) {
      encode_row(rules, rgba.data(), static_cast<int>(width), form.dither_x, form.dither_y + first + i,
                 reinterpret_cast<std::uint16_t*>(bytes));
    } else {
      for (std::size_t x = 0; x < width; ++x) std::copy_n(&rgba[x * 4], channels, &packed[x * channels]);
      if (form.type == SampleType::half) {
        to_half(packed.data(), reinterpret_cast<std::uint16_t*>(bytes), packed.size());
      } else {
        std::copy_n(packed.data(), packed.size(), reinterpret_cast<float*>(bytes));
      }
    }
  }
}

void encode_strip(const Picture& picture, const StripForm& form, int first, int rows, std::uint8_t* bytes) {
  parallel_rows(rows, static_cast<long long>(picture.display_window.width) * rows * 4, [&](int begin, int end) {
    encode_rows(picture, form, first + begin, end - begin,
                bytes + form.row_bytes(picture) * static_cast<std::size_t>(begin));
  });
}

}  // namespace afterglow
