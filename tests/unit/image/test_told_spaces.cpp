// SPDX-License-Identifier: MIT
// What files say of their colours, and what is told where they cannot.
#include <gmock/gmock.h>

#include <array>
#include <fstream>
#include <numeric>
#include <random>

#include "core/file.h"
#include "image/srgb.h"
#include "make_files.h"
#include "raw_png.h"
#include "temporary_folder.h"
#include "wedge.h"

namespace afterglow {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// Everything that is told while this is written.
std::string told_of(const Picture& picture, const std::filesystem::path& file, const WriteOptions& options) {
  std::string told;
  Diagnostics diagnostics([&](Severity, const std::string& message) { told += message + "\n"; });
  const auto written = write_picture(picture, file, options, diagnostics);
  EXPECT_TRUE(written) << written.error().text();
  return told;
}

TEST(ToldSpaces, PngSaysWhatIsNotSrgb) {
  const TemporaryFolder folder;
  for (const auto& [name, chunk] : {std::pair("pq", "cICP\x09\x10"),
                                    {"hlg", "cICP\x09\x12"},
                                    {"display_p3", "cICP\x0c\x0d"},
                                    {"adobe_rgb", "cHRM"}}) {
    Picture picture = wedge(37, 20, false);
    for (std::size_t i = 0; i < picture.color.pixels.size(); ++i)
      if (i % 4 != 3) picture.color.pixels[i] = std::min(picture.color.pixels[i], 0.9f);
    const WriteOptions options = with(SampleType::uint16, find_output_space(name).value());
    EXPECT_THAT(told_of(picture, folder / "a.png", options), IsEmpty()) << name;
    EXPECT_THAT(read_file(folder / "a.png").value(), HasSubstr(chunk)) << name;
    const Picture back = read_or_fail(folder / "a.png");
    for (std::size_t i = 0; i < picture.color.pixels.size(); ++i)
      ASSERT_NEAR(back.color.pixels[i], picture.color.pixels[i], 5e-4) << name << " " << i;
  }
}

TEST(ToldSpaces, OthersAreTold) {
  const TemporaryFolder folder;
  const Picture picture = wedge(36, 36, false);
  const OutputSpace *pq = find_output_space("pq").value(), *log = find_output_space("logc3").value();
  EXPECT_THAT(told_of(picture, folder / "a.tif", with(SampleType::uint16, pq)),
              HasSubstr("does not say that it holds 'pq': programs take it for sRGB until they are told; PNG says it"));
  EXPECT_THAT(told_of(picture, folder / "b.tif", with(SampleType::uint16, log)), IsEmpty());
  EXPECT_THAT(told_of(picture, folder / "c.jp2", with(SampleType::uint16, log)),
              HasSubstr("c.jp2: holds 'logc3' and says that it is sRGB"));
  EXPECT_THAT(told_of(picture, folder / "d.jp2", with(SampleType::uint16)), IsEmpty());
  Picture view = wedge(36, 36, false);
  view.view = true;
  EXPECT_THAT(told_of(view, folder / "e.jp2", with(SampleType::uint16)), HasSubstr("holds codes of a view"));
}

/// PNG, 11.3.2: a power is a power where primaries say that it is not sRGB.
TEST(ToldSpaces, GammaOf45455BesidePrimariesIsAPower) {
  const TemporaryFolder folder;
  const auto read = [&](std::uint32_t green_x) {
    RawPng png(1, 1, 8, 2);
    std::string primaries;
    for (const std::uint32_t v : {31270u, 32900u, 64000u, 33000u, green_x, 60000u, 15000u, 6000u})
      primaries += RawPng::big_endian(v);
    png.chunk("gAMA", RawPng::big_endian(45455)).chunk("cHRM", primaries).pixels({std::string("\x11\x11\x11", 3)});
    std::ofstream(folder / "a.png", std::ios::binary) << png.finish();
    return static_cast<double>(read_or_fail(folder / "a.png").color.pixels[1]);
  };
  EXPECT_NEAR(read(26500), std::pow(17 / 255.0, 1 / 0.45455), 1e-5);
  EXPECT_NEAR(read(30000), srgb_to_linear(17 / 255.0), 1e-5) << "those of sRGB";
}

/// Mantissas are rounded, so that no light is lost on average.
TEST(ToldSpaces, RadianceKeepsTheLightOnAverage) {
  const TemporaryFolder folder;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> light(0.01f, 1);
  Picture picture = wedge(128, 64, false);
  for (float& v : picture.color.pixels) v = light(random);
  picture.color.pixels[0] = 0.9999f;  // rounds to the next power of two
  ASSERT_TRUE(write(picture, folder / "a.hdr"));
  const Picture back = read_or_fail(folder / "a.hdr");
  std::array<double, 2> sums{};
  for (std::size_t i = 0; i < picture.color.pixels.size(); i += 4) {
    const float* given = &picture.color.pixels[i];
    const float most = std::max({given[0], given[1], given[2]});
    for (std::size_t c = 0; c < 3; ++c) {
      sums[0] += static_cast<double>(given[c]);
      sums[1] += static_cast<double>(back.color.pixels[i + c]);
      ASSERT_NEAR(back.color.pixels[i + c], given[c], most / 255) << "half a step, of 128 or more of the brightest";
    }
  }
  EXPECT_NEAR(sums[1] / sums[0], 1, 2e-4);
}

/// A grey AVIF of 10 bits, 16x16.
TEST(ToldSpaces, BitsOfHeifThatAreNotReadAreTold) {
  constexpr std::string_view kHex =
      "00000020667479706176696600000000617669666d6966316d6961664d413142000000f96d657461000000000000002f68646c72000000"
      "0000000000706963740000000000000000000000005069637475726548616e646c6572000000000e7069746d0000000000010000001e69"
      "6c6f63000000004400000100010000000100000121000000140000002869696e660000000000010000001a696e66650200000000010000"
      "61763031436f6c6f72000000006a697072700000004b6970636f0000001469737065000000000000001000000010000000107069786900"
      "000000030a0a0a0000000c6176314381004c0000000013636f6c726e636c78000200020002000000001769706d61000000000000000100"
      "0104010283040000001c6d6461740a06180cffdb8080320a1a000000500000000068";
  const TemporaryFolder folder;
  std::ofstream out(folder / "a.avif", std::ios::binary);
  for (std::size_t i = 0; i < kHex.size(); i += 2)
    out.put(static_cast<char>(std::stoi(std::string(kHex.substr(i, 2)), nullptr, 16)));
  out.close();
  std::string told;
  Diagnostics diagnostics([&](Severity, const std::string& message) { told += message + "\n"; });
  const auto read = read_picture(folder / "a.avif", {}, diagnostics);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_THAT(told, HasSubstr("a.avif: has 10 bits a sample and is read with 8"));
}

}  // namespace
}  // namespace afterglow
