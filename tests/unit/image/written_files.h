// SPDX-License-Identifier: MIT
// Pictures to write, and what stands in the files.
#pragma once

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "image/writer.h"
#include "make_files.h"

namespace afterglow {

inline Picture make_picture(int width, int height, bool alpha) {
  Picture picture;
  picture.color = Image(width, height, 4);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float* pixel = picture.color.at(x, y);
      pixel[3] = alpha ? mark(x, y, 3) : 1;
      for (int c = 0; c < 3; ++c) pixel[c] = mark(x, y, c) * pixel[3];
    }
  }
  picture.has_alpha = alpha;
  picture.data_window = picture.display_window = {0, 0, width, height};
  return picture;
}

// Rounded to the nearest code, so that it can be told what comes out; Dither.* look at the noise.
inline void write_or_fail(const Picture& picture, const std::filesystem::path& file, WriteOptions options = {}) {
  if (!options.dither) options.dither = false;
  Diagnostics silent;
  const auto written = write_picture(picture, file, options, silent);
  ASSERT_TRUE(written) << written.error().text();
}

inline OIIO::ImageSpec spec_of(const std::filesystem::path& file) {
  const auto input = OIIO::ImageInput::open(file.string());
  EXPECT_TRUE(input) << OIIO::geterror();
  return input ? input->spec() : OIIO::ImageSpec();
}

template <class T>
std::vector<T> samples_of(const std::filesystem::path& file, OIIO::TypeDesc type) {
  OIIO::ImageSpec raw;
  raw.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::open(file.string(), &raw);
  EXPECT_TRUE(input) << OIIO::geterror();
  const OIIO::ImageSpec& spec = input->spec();
  std::vector<T> samples(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
  EXPECT_TRUE(input->read_image(0, 0, 0, spec.nchannels, type, samples.data())) << input->geterror();
  return samples;
}

}  // namespace afterglow
