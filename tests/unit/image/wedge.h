// SPDX-License-Identifier: MIT
// A small picture whose Cineon codes are known, and ways to write it.
#pragma once

#include <filesystem>

#include "image/input_space.h"
#include "image/output_space.h"
#include "image/writer.h"

namespace afterglow {

/// Greys whose Cineon codes are 95, 95 + step, …; red, green and blue differ.
inline Picture wedge(int width, int height, bool alpha) {
  Picture picture;
  picture.color = Image(width, height, 4);
  const InputSpace& cineon = *find_input_space("cineon").value();
  for (int i = 0; i < width * height; ++i) {
    float* pixel = &picture.color.pixels[static_cast<std::size_t>(i) * 4];
    pixel[3] = alpha ? static_cast<float>(i % 5) / 4 : 1;
    for (int c = 0; c < 3; ++c)
      pixel[c] = static_cast<float>(cineon.to_linear((95 + (i * 7 + c * 131) % 900) / 1023.0)) * pixel[3];
  }
  picture.has_alpha = alpha;
  picture.data_window = picture.display_window = {0, 0, width, height};
  return picture;
}

/// Rounded to the nearest code, in this type and space.
inline WriteOptions with(SampleType type, const OutputSpace* space = nullptr) {
  WriteOptions options;
  options.type = type;
  options.space = space;
  options.dither = false;
  return options;
}
inline WriteOptions compressed(const char* compression) {
  WriteOptions options;
  options.compression = compression;
  return options;
}

inline Result<void> write(const Picture& picture, const std::filesystem::path& file, const WriteOptions& options = {}) {
  Diagnostics silent;
  return write_picture(picture, file, options, silent);
}

}  // namespace afterglow
