// SPDX-License-Identifier: MIT
// Makes input files with OpenImageIO and OpenEXR themselves.
#pragma once

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "image/reader.h"

namespace afterglow {

/// A value that tells pixel and channel apart, in [0, 1), a multiple of 1/1024 (exact as half, nearly as 16-bit
/// integer).
inline float mark(int x, int y, int channel) {
  return static_cast<float>((x * 37 + y * 101 + channel * 311 + 5) % 1021) / 1024.0f;
}

inline std::vector<float> marks(int width, int height, int channels) {
  std::vector<float> samples;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c) samples.push_back(mark(x, y, c));
  return samples;
}

/// Writes parts (one, for most formats) of interleaved float samples, converted by OpenImageIO.
inline void make_file(const std::filesystem::path& file, const std::vector<OIIO::ImageSpec>& specs,
                      const std::vector<std::vector<float>>& samples) {
  auto out = OIIO::ImageOutput::create(file.string());
  ASSERT_TRUE(out) << OIIO::geterror();
  const bool opened = specs.size() == 1 ? out->open(file.string(), specs[0])
                                        : out->open(file.string(), static_cast<int>(specs.size()), specs.data());
  ASSERT_TRUE(opened) << out->geterror();
  for (std::size_t i = 0; i < specs.size(); ++i) {
    if (i > 0) {
      ASSERT_TRUE(out->open(file.string(), specs[i], OIIO::ImageOutput::AppendSubimage)) << out->geterror();
    }
    ASSERT_TRUE(out->write_image(OIIO::TypeFloat, samples[i].data())) << out->geterror();
  }
  ASSERT_TRUE(out->close()) << out->geterror();
}

inline OIIO::ImageSpec make_spec(int width, int height, const std::vector<std::string>& channels, OIIO::TypeDesc type) {
  OIIO::ImageSpec spec(width, height, static_cast<int>(channels.size()), type);
  spec.channelnames = channels;
  spec.alpha_channel = -1;
  for (std::size_t i = 0; i < channels.size(); ++i)
    if (channels[i] == "A") spec.alpha_channel = static_cast<int>(i);
  return spec;
}

inline void make_file(const std::filesystem::path& file, int width, int height,
                      const std::vector<std::string>& channels, OIIO::TypeDesc type) {
  make_file(file, {make_spec(width, height, channels, type)},
            {marks(width, height, static_cast<int>(channels.size()))});
}

/// Collects what a Diagnostics is told.
struct Messages {
  std::vector<std::string> warnings, notes;
  Diagnostics diagnostics{[this](Severity severity, const std::string& text) {
    (severity == Severity::warning ? warnings : notes).push_back(text);
  }};
};

/// Reads; ends the test as failed when that fails.
inline Picture read_or_fail(const std::filesystem::path& file, const ReadOptions& options = {}) {
  Diagnostics silent;
  auto picture = read_picture(file, options, silent);
  if (!picture) throw std::runtime_error(picture.error().text());
  return std::move(picture).value();
}

inline std::filesystem::path test_image(const std::string& name) {
  return std::filesystem::path(AFTERGLOW_TEST_FOLDER) / "images" / name;
}

}  // namespace afterglow
