// SPDX-License-Identifier: MIT
// Every format that is written is read again within a code.
#include <gtest/gtest.h>

#include <cmath>

#include "image/srgb.h"
#include "temporary_folder.h"
#include "written_files.h"

namespace afterglow {
namespace {

struct Format {
  const char* name;
  const char* file;
  SampleType type;
  int codes;  ///< largest; 0: floats
  bool keeps_alpha;
  double relative;  ///< of floats; below 0: exactly
};
const Format kFormats[] = {
    {"ExrHalf", "o.exr", SampleType::half, 0, true, 1.0 / 2048},
    {"ExrFloat", "o.exr", SampleType::float32, 0, true, 0},
    {"Png8", "o.png", SampleType::uint8, 255, true, 0},
    {"Png16", "o.png", SampleType::uint16, 65535, true, 0},
    {"Tiff8", "o.tif", SampleType::uint8, 255, true, 0},
    {"Tiff16", "o.tiff", SampleType::uint16, 65535, true, 0},
    {"TiffFloat", "o.tif", SampleType::float32, 0, true, 0},
    {"TiffHalf", "o.tif", SampleType::half, 0, true, 1.0 / 2048},
    {"Hdr", "o.hdr", SampleType::float32, 0, false, 1.0 / 128},
    {"Targa", "o.tga", SampleType::uint8, 255, true, 0},
    {"Ppm8", "o.ppm", SampleType::uint8, 255, false, 0},
    {"Pfm", "o.pfm", SampleType::float32, 0, false, -1},
};

class RoundTrip : public testing::TestWithParam<std::tuple<Format, Size, bool>> {};

TEST_P(RoundTrip, WithinACode) {
  const auto& [format, size, alpha] = GetParam();
  const TemporaryFolder folder;
  const Picture picture = make_picture(size.width, size.height, alpha);
  WriteOptions options;
  options.type = format.type;
  ASSERT_NO_FATAL_FAILURE(write_or_fail(picture, folder / format.file, options));
  EXPECT_EQ(folder.count(), 1);
  const Picture back = read_or_fail(folder / format.file);
  ASSERT_EQ(back.color.size(), size);
  EXPECT_EQ(back.has_alpha, alpha && format.keeps_alpha);
  const auto near_code = [&](double a, double b) {
    return std::abs(linear_to_srgb(a) - linear_to_srgb(b)) * format.codes <= 0.5001;
  };
  for (std::size_t i = 0; i < picture.color.pixels.size(); i += 4) {
    const float* in = &picture.color.pixels[i];
    const float* out = &back.color.pixels[i];
    const double a = back.has_alpha ? out[3] : 1;
    if (back.has_alpha) {
      ASSERT_NEAR(a, in[3], format.codes > 0 ? 0.5001 / format.codes : format.relative);
    }
    for (int c = 0; c < 3; ++c) {
      if (format.codes > 0) {
        // Straight colour is what is stored, each with its own alpha.
        if (a > 0 && in[3] > 0) {
          ASSERT_TRUE(near_code(out[c] / a, back.has_alpha ? std::min(in[c] / in[3], 1.0f) : in[c]))
              << in[c] << " → " << out[c];
        }
      } else {
        // HDR shares one exponent between the channels.
        const double scale = format.keeps_alpha ? in[c] : std::max({in[0], in[1], in[2]});
        ASSERT_NEAR(out[c], in[c], format.relative < 0 ? 0 : scale * format.relative + 6e-8);
      }
    }
  }
}

std::string round_trip_name(const testing::TestParamInfo<std::tuple<Format, Size, bool>>& info) {
  const auto& [format, size, alpha] = info.param;
  return std::string(format.name) + "_" + std::to_string(size.width) + "x" + std::to_string(size.height) +
         (alpha ? "_alpha" : "");
}
// OpenImageIO multiplies alpha into the codes of WebP as it reads them: WebpHoldsStraightCodes looks at those.
INSTANTIATE_TEST_SUITE_P(WebP, RoundTrip,
                         testing::Combine(testing::Values(Format{"WebP", "o.webp", SampleType::uint8, 255, true, 0}),
                                          testing::Values(Size{1, 1}, Size{64, 130}, Size{37, 53}),
                                          testing::Values(false)),
                         round_trip_name);
const Format kJpeg2000[] = {
    {"Jpeg2000_8", "o.jp2", SampleType::uint8, 255, true, 0},
    {"Jpeg2000_16", "o.j2k", SampleType::uint16, 65535, true, 0},
};
INSTANTIATE_TEST_SUITE_P(Jpeg2000, RoundTrip,
                         testing::Combine(testing::ValuesIn(kJpeg2000),
                                          testing::Values(Size{32, 32}, Size{64, 130}, Size{37, 53}), testing::Bool()),
                         round_trip_name);
INSTANTIATE_TEST_SUITE_P(All, RoundTrip,
                         testing::Combine(testing::ValuesIn(kFormats),
                                          testing::Values(Size{1, 1}, Size{64, 130}, Size{37, 53}, Size{3, 300}),
                                          testing::Bool()),
                         round_trip_name);

}  // namespace
}  // namespace afterglow
