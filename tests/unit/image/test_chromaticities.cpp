// SPDX-License-Identifier: MIT
// One scene in four EXR files, as the published set has it in Chromaticities/: Rec.709 and CIE XYZ, each as RGB and as
// luminance and chroma. Read, they look alike. What goes into the files is computed here from chromaticities, in double
// precision.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gtest/gtest.h>
#include <half.h>

#include <array>
#include <cmath>
#include <vector>

#include "image/reader.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {

constexpr int kFourSide = 64;
using LightTriple = std::array<double, 3>;

/// Smooth light with colours, a grey half and a bright spot; never black, as the chroma of black is none.
LightTriple scene_light(int x, int y) {
  const double u = (x + 0.5) / kFourSide, v = (y + 0.5) / kFourSide;
  const double spot = 6 * std::exp(-40 * ((u - 0.7) * (u - 0.7) + (v - 0.4) * (v - 0.4)));
  const double color = 0.35 * std::sin(3.14159265358979 * v);
  return {0.2 + 0.3 * u + spot, 0.2 + 0.3 * u - color * 0.4 * u + spot, 0.25 + 0.25 * u + color * (1 - u) + spot * 0.8};
}

// IEC 61966-2-1 gives this to four digits; here from Rec.709's primaries and D65 by solving for white, independently.
LightTriple xyz_of_rec709(const LightTriple& c) {
  static const auto columns = [] {
    const double xy[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
    const double white[3] = {0.3127 / 0.3290, 1, (1 - 0.3127 - 0.3290) / 0.3290};
    double m[3][4];
    for (int i = 0; i < 3; ++i) {
      for (int p = 0; p < 3; ++p) m[i][p] = i == 0 ? xy[p][0] : i == 1 ? xy[p][1] : 1 - xy[p][0] - xy[p][1];
      m[i][3] = white[i];
    }
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i) {
        if (i == k) continue;
        const double f = m[i][k] / m[k][k];
        for (int j = 0; j < 4; ++j) m[i][j] -= f * m[k][j];
      }
    std::array<LightTriple, 3> out{};
    for (std::size_t p = 0; p < 3; ++p) {
      const double scale = m[p][3] / m[p][p];
      out[p] = {xy[p][0] * scale, xy[p][1] * scale, (1 - xy[p][0] - xy[p][1]) * scale};
    }
    return out;
  }();
  LightTriple out{};
  for (std::size_t i = 0; i < 3; ++i) out[i] = c[0] * columns[0][i] + c[1] * columns[1][i] + c[2] * columns[2][i];
  return out;
}

enum class StoredAs { rec709, xyz };

LightTriple stored_light(int x, int y, StoredAs space) {
  const LightTriple light = scene_light(x, y);
  return space == StoredAs::xyz ? xyz_of_rec709(light) : light;
}

Imf::Header four_header(StoredAs space) {
  Imf::Header header(kFourSide, kFourSide);
  if (space == StoredAs::xyz)
    Imf::addChromaticities(header,
                           {Imath::V2f(1, 0), Imath::V2f(0, 1), Imath::V2f(0, 0), Imath::V2f(1 / 3.F, 1 / 3.F)});
  else
    Imf::addChromaticities(header, {});
  return header;
}

void write_planes(const std::filesystem::path& file, Imf::Header header, const std::vector<const char*>& names,
                  const std::vector<int>& steps, std::vector<std::vector<half>>& planes) {
  Imf::FrameBuffer buffer;
  for (std::size_t i = 0; i < names.size(); ++i) {
    header.channels().insert(names[i], Imf::Channel(Imf::HALF, steps[i], steps[i]));
    buffer.insert(names[i],
                  Imf::Slice(Imf::HALF, reinterpret_cast<char*>(planes[i].data()), sizeof(half),
                             sizeof(half) * static_cast<std::size_t>(kFourSide / steps[i]), steps[i], steps[i]));
  }
  Imf::OutputFile out(file.c_str(), header);
  out.setFrameBuffer(buffer);
  out.writePixels(kFourSide);
}

void write_rgb(const std::filesystem::path& file, StoredAs space) {
  std::vector<std::vector<half>> planes(3);
  for (int y = 0; y < kFourSide; ++y)
    for (int x = 0; x < kFourSide; ++x) {
      const LightTriple c = stored_light(x, y, space);
      for (std::size_t i = 0; i < 3; ++i) planes[i].emplace_back(static_cast<float>(c[i]));
    }
  write_planes(file, four_header(space), {"R", "G", "B"}, {1, 1, 1}, planes);
}

/// Y everywhere; RY = (R − Y)/Y and BY = (B − Y)/Y at every other pixel of every other row. Y of Rec.709 is its
/// luminance, that of XYZ is what stands in its place.
void write_chroma(const std::filesystem::path& file, StoredAs space) {
  std::vector<std::vector<half>> planes(3);
  for (int y = 0; y < kFourSide; ++y)
    for (int x = 0; x < kFourSide; ++x) {
      const LightTriple c = stored_light(x, y, space);
      const double luminance = space == StoredAs::xyz ? c[1] : xyz_of_rec709(c)[1];
      planes[0].emplace_back(static_cast<float>(luminance));
      if (x % 2 || y % 2) continue;
      planes[1].emplace_back(static_cast<float>((c[0] - luminance) / luminance));
      planes[2].emplace_back(static_cast<float>((c[2] - luminance) / luminance));
    }
  write_planes(file, four_header(space), {"Y", "RY", "BY"}, {1, 2, 2}, planes);
}

/// Largest difference of what is read to the scene, in parts of the pixel's brightest channel.
/// `margin` pixels at the edges do not count.
double off_scene(const std::filesystem::path& file, int margin = 0) {
  Diagnostics ignored;
  const auto picture = read_picture(file, {}, ignored);
  if (!picture) throw std::runtime_error(picture.error().text());
  double worst = 0;
  for (int y = margin; y < kFourSide - margin; ++y)
    for (int x = margin; x < kFourSide - margin; ++x) {
      const LightTriple wanted = scene_light(x, y);
      const double size = std::max(wanted[0], std::max(wanted[1], wanted[2]));
      for (std::size_t c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(double(picture->color.at(x, y)[c]) - wanted[c]) / size);
    }
  return worst;
}

TEST(Chromaticities, FourFilesOfOneSceneLookAlike) {
  const TemporaryFolder folder;
  constexpr double kHalf = 1.0 / 2048;  // rounding of a half float
  write_rgb(folder / "rec709.exr", StoredAs::rec709);
  write_rgb(folder / "xyz.exr", StoredAs::xyz);
  write_chroma(folder / "rec709_yc.exr", StoredAs::rec709);
  write_chroma(folder / "xyz_yc.exr", StoredAs::xyz);
  EXPECT_LT(off_scene(folder / "rec709.exr"), kHalf);
  EXPECT_LT(off_scene(folder / "xyz.exr"), 5 * kHalf);  // the largest row of the matrix adds up to 5.3
  // Chroma between its samples is what OpenEXR's filter of 27 taps makes of them; beyond the edges it is mirrored or
  // cut.
  for (const char* name : {"rec709_yc.exr", "xyz_yc.exr"}) {
    EXPECT_LT(off_scene(folder / name, 14), 0.004) << name;
    EXPECT_LT(off_scene(folder / name), 0.06) << name;
  }
}

// The same numbers under the wrong name are another picture: the test would see it.
TEST(Chromaticities, AreWhatMakesThemAlike) {
  const TemporaryFolder folder;
  std::vector<std::vector<half>> planes(3);
  for (int y = 0; y < kFourSide; ++y)
    for (int x = 0; x < kFourSide; ++x) {
      const LightTriple c = stored_light(x, y, StoredAs::xyz);
      for (std::size_t i = 0; i < 3; ++i) planes[i].emplace_back(static_cast<float>(c[i]));
    }
  write_planes(folder / "wrong.exr", four_header(StoredAs::rec709), {"R", "G", "B"}, {1, 1, 1}, planes);
  EXPECT_GT(off_scene(folder / "wrong.exr"), 0.05);
}

}  // namespace
}  // namespace afterglow
