// SPDX-License-Identifier: MIT
// From a video's samples to light: RGB against FFmpeg's zscale at the source's depth, curves against their formulas.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <random>

#include "clips.h"
#include "core/file.h"
#include "image/picture_file.h"

namespace afterglow {
namespace {

struct ColourCase {
  const char* name;
  const char* pixels;  ///< FFmpeg's pixel format of the clip
  const char* matrix;  ///< FFmpeg's words
  const char* range;
  const char* rgb;  ///< format of the reference, of the same depth
  int depth;
  int width = 64, height = 48;
  const char* place = "left";
};
void PrintTo(const ColourCase& one, std::ostream* out) { *out << one.name; }

class Colour : public Clips, public testing::WithParamInterface<ColourCase> {};

/// Smooth and rough content over the whole range of codes.
std::string random_frame(const std::string& file, const ColourCase& c) {
  std::mt19937 random(3);
  std::ofstream out(file, std::ios::binary);
  const unsigned most = (1u << c.depth) - 1;
  for (int i = 0; i < c.width * c.height * 3; ++i) {
    const unsigned value = (i / 7) % 3 == 0 ? random() % (most + 1) : static_cast<unsigned>(i) * 5 % (most + 1);
    out.put(static_cast<char>(value & 255));
    if (c.depth > 8) out.put(static_cast<char>(value >> 8));
  }
  return file;
}

/// FFmpeg's options for a clip of these tags: on the frames too, so that it has nothing to convert.
std::string tags_of(const std::string& matrix, const std::string& range, const std::string& primaries,
                    const std::string& transfer) {
  return fmt::format(
      "-vf setparams=colorspace={0}:range={1}:color_primaries={2}:color_trc={3} -colorspace {0} "
      "-color_range {1} -color_primaries {2} -color_trc {3}",
      matrix, range, primaries, transfer);
}

TEST_P(Colour, RgbIsThatOfZscale) {
  const ColourCase& c = GetParam();
  random_frame(path("frame.raw"), c);
  const std::string place = c.place;
  const std::string codec =
      place == "left"
          ? "ffv1 -level 3 -chroma_sample_location left"
          : fmt::format("libx264 -qp 0 -bsf:v h264_metadata=chroma_sample_loc_type={}", place == "center" ? 1 : 2);
  ffmpeg(
      fmt::format("-f rawvideo -pix_fmt {0} -s {1}x{2} -color_range {3} -i '{4}' -frames:v 1 {5} -c:v {6} "
                  "-pix_fmt {0} '{7}'",
                  c.pixels, c.width, c.height, c.range, path("frame.raw"), tags_of(c.matrix, c.range, "bt709", "bt709"),
                  codec, path("clip.mkv")));
  const std::string transfer = std::string(c.matrix) == "bt2020nc" ? "2020_10" : "709";
  ffmpeg(
      fmt::format("-i '{}' -vf "
                  "zscale=matrixin={}:rangein={}:transferin={}:primariesin=709:chromalin={}:matrix=gbr:range=full:"
                  "transfer={}:primaries=709:dither=none,format={} -f rawvideo '{}'",
                  path("clip.mkv"), c.matrix, std::string(c.range) == "pc" ? "full" : "limited", transfer, c.place,
                  transfer, c.rgb, path("rgb.raw")));
  const auto movie = open(path("clip.mkv"));
  ASSERT_TRUE(movie);
  EXPECT_EQ(movie->facts().pixel_format, c.pixels);
  const auto frame = Movie::frame(movie, 0);
  Image stored(c.width, c.height, 3);
  std::vector<ReadTarget> targets;
  for (int channel = 0; channel < 3; ++channel)
    targets.push_back({channel, stored.pixels.data() + channel, 3, static_cast<std::size_t>(c.width) * 3});
  const auto read = frame->read(0, targets);
  ASSERT_TRUE(read) << read.error().text();
  const std::string bytes = read_file(path("rgb.raw")).value();
  const int bytes_each = c.depth > 8 ? 2 : 1;
  const std::size_t plane = static_cast<std::size_t>(c.width) * static_cast<std::size_t>(c.height);
  ASSERT_EQ(bytes.size(), plane * 3 * static_cast<std::size_t>(bytes_each));
  const double most = (1 << c.depth) - 1;
  double worst = 0;
  for (std::size_t i = 0; i < plane; ++i)
    for (int channel = 0; channel < 3; ++channel) {
      const std::size_t at =
          (static_cast<std::size_t>((channel + 2) % 3) * plane + i) * static_cast<std::size_t>(bytes_each);
      int code = static_cast<std::uint8_t>(bytes[at]);
      if (bytes_each == 2) code |= static_cast<std::uint8_t>(bytes[at + 1]) << 8;
      const double own = std::clamp<double>(stored.pixels[i * 3 + static_cast<std::size_t>(channel)], 0, 1) * most;
      worst = std::max(worst, std::abs(own - code));
    }
  RecordProperty("worst_codes", fmt::format("{:.4f}", worst));
  EXPECT_LE(worst, 1) << "codes of " << c.depth << " bits";
}

INSTANTIATE_TEST_SUITE_P(Video, Colour,
                         testing::Values(ColourCase{"bt709_tv", "yuv420p", "bt709", "tv", "gbrp", 8},
                                         ColourCase{"bt709_pc", "yuv420p", "bt709", "pc", "gbrp", 8},
                                         ColourCase{"bt601_tv", "yuv422p", "smpte170m", "tv", "gbrp", 8},
                                         ColourCase{"bt470bg_pc", "yuv444p", "bt470bg", "pc", "gbrp", 8},
                                         ColourCase{"bt709_10", "yuv420p10le", "bt709", "tv", "gbrp10le", 10},
                                         ColourCase{"bt2020_10", "yuv422p10le", "bt2020nc", "tv", "gbrp10le", 10},
                                         ColourCase{"bt2020_12", "yuv444p12le", "bt2020nc", "pc", "gbrp12le", 12},
                                         ColourCase{"centre", "yuv420p", "bt709", "tv", "gbrp", 8, 64, 48, "center"},
                                         ColourCase{"topleft", "yuv420p10le", "bt2020nc", "tv", "gbrp10le", 10, 64, 48,
                                                    "topleft"},
                                         ColourCase{"ycgco", "yuv444p", "ycgco", "pc", "gbrp", 8}),
                         [](const auto& info) { return std::string(info.param.name); });

/// A frame of one grey code in 10 bits of full range, and the light that it is read as.
class Curves : public Clips {
 protected:
  double light_of(const std::string& transfer, const std::string& primaries, int code) {
    std::ofstream raw(path("grey.raw"), std::ios::binary);
    for (int i = 0; i < 32 * 32; ++i) raw.put(static_cast<char>(code & 255)).put(static_cast<char>(code >> 8));
    for (int i = 0; i < 2 * 32 * 32; ++i) raw.put(0).put(2);
    raw.close();
    const std::string file = path(fmt::format("{}{}.mkv", transfer, code));
    ffmpeg(fmt::format("-f rawvideo -pix_fmt yuv444p10le -s 32x32 -color_range pc -i '{}' {} -c:v ffv1 -level 3 '{}'",
                       path("grey.raw"), tags_of("bt2020nc", "pc", primaries, transfer), file));
    const auto movie = open(file);
    if (!movie) return -1;
    const auto picture = read(movie, 0);
    return picture ? picture->color.at(16, 16)[1] : -1;
  }
};

TEST_F(Curves, AreUndoneToLight) {
  const auto rec709 = [](double v) {
    return v < 0.081243 ? v / 4.5 : std::pow((v + 0.09929682680944) / 1.09929682680944, 1 / 0.45);
  };
  const auto pq = [](double v) {  // ST 2084, in units of 203 cd/m²
    const double p = std::pow(v, 32.0 / 2523);
    return 10000.0 / 203 * std::pow(std::max(p - 107.0 / 128, 0.0) / (2413.0 / 128 - 2392.0 / 128 * p), 8192.0 / 1305);
  };
  const auto hlg = [](double v) {
    const double a = 0.17883277, b = 1 - 4 * a, c = 0.5 - a * std::log(4 * a);
    const auto scene = [&](double e) { return e <= 0.5 ? e * e / 3 : (std::exp((e - c) / a) + b) / 12; };
    return scene(v) / scene(0.75);
  };
  const auto srgb = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
  const auto check = [&](const char* transfer, const char* primaries, const auto& curve) {
    for (const int code : {40, 300, 512, 767, 1023}) {
      const double expected = curve(code / 1023.0);
      EXPECT_NEAR(light_of(transfer, primaries, code), expected, 2e-5 + 2e-5 * expected) << transfer << " " << code;
    }
  };
  check("bt709", "bt709", rec709);
  check("smpte170m", "smpte170m", rec709);
  check("bt2020-10", "bt2020", rec709);
  check("smpte2084", "bt2020", pq);
  check("arib-std-b67", "bt2020", hlg);
  check("iec61966-2-1", "bt709", srgb);
}

/// Saturated colours through matrix, PQ and primaries, against zscale's linear light.
TEST_F(Curves, PqInRec2020IsTheLightOfZscale) {
  constexpr ColourCase kCase{"pq", "yuv444p10le", "bt2020nc", "tv", "gbrpf32le", 10};
  random_frame(path("frame.raw"), kCase);
  ffmpeg(fmt::format("-f rawvideo -pix_fmt yuv444p10le -s 64x48 -i '{}' -frames:v 1 {} -c:v ffv1 -level 3 '{}'",
                     path("frame.raw"), tags_of("bt2020nc", "tv", "bt2020", "smpte2084"), path("pq.mkv")));
  ffmpeg(
      fmt::format("-i '{}' -vf "
                  "zscale=rangein=limited:matrixin=bt2020nc:transferin=smpte2084:primariesin=bt2020:matrix=gbr:range="
                  "full:transfer=linear:npl=203:primaries=bt709,format=gbrpf32le -f rawvideo '{}'",
                  path("pq.mkv"), path("linear.raw")));
  const auto movie = open(path("pq.mkv"));
  ASSERT_TRUE(movie);
  const auto picture = read(movie, 0).value();
  const std::string bytes = read_file(path("linear.raw")).value();
  const auto* planes = reinterpret_cast<const float*>(bytes.data());
  const auto code = [](double light) {  // PQ's code of 10 bits
    const double y = std::pow(std::max(light, 0.0) * 203 / 10000, 1305.0 / 8192);
    return 1023 * std::pow((107.0 / 128 + 2413.0 / 128 * y) / (1 + 2392.0 / 128 * y), 2523.0 / 32);
  };
  // Samples that are colours: many of the random ones lie outside of RGB's cube, where curves go on as they like.
  Image stored(64, 48, 3);
  std::vector<ReadTarget> targets;
  for (int channel = 0; channel < 3; ++channel) targets.push_back({channel, stored.pixels.data() + channel, 3, 64 * 3});
  ASSERT_TRUE(Movie::frame(movie, 0)->read(0, targets));
  const auto light_of_code = [](double v) {  // ST 2084, in units of 203 cd/m²
    const double p = std::pow(v, 32.0 / 2523);
    return 10000.0 / 203 * std::pow(std::max(p - 107.0 / 128, 0.0) / (2413.0 / 128 - 2392.0 / 128 * p), 8192.0 / 1305);
  };
  constexpr std::array<std::array<double, 3>, 3> kToRec709{
      {{1.6604910021084345, -0.5876411387885495, -0.0728498633198849},
       {-0.1245504745215907, 1.1328998971259603, -0.0083494226043695},
       {-0.0181507633549053, -0.1005788980080074, 1.1187296613629127}}};
  double worst = 0, own_worst = 0;
  std::string where;
  int compared = 0;
  for (std::size_t i = 0; i < 64 * 48; ++i) {
    const float* own = &stored.pixels[i * 3];
    if (std::min({own[0], own[1], own[2]}) < 0 || std::max({own[0], own[1], own[2]}) > 1) continue;
    ++compared;
    const float* light = &picture.color.pixels[i * 4];
    const float brightest = std::max({light[0], light[1], light[2]});
    for (std::size_t c = 0; c < 3; ++c) {
      const float other = planes[(c + 2) % 3 * 64 * 48 + i];
      double truth = 0;
      for (std::size_t k = 0; k < 3; ++k) truth += kToRec709[c][k] * light_of_code(own[k]);
      own_worst = std::max(own_worst, std::abs(light[c] - std::max(truth, 0.0)) / brightest);
      // What is left where bright primaries cancel is the rounding of zscale's matrix, which differs between
      // processors.
      if (std::abs(light[c] - std::max(other, 0.0f)) < 2e-5f * brightest) continue;
      const double difference = std::abs(code(light[c]) - code(other));
      if (difference > worst) where = fmt::format("{:g}, zscale {:g}, beside {:g}", light[c], other, brightest);
      worst = std::max(worst, difference);
    }
  }
  EXPECT_GT(compared, 300);
  EXPECT_LE(own_worst, 2e-6) << "against double precision, of the brightest channel";
  EXPECT_LE(worst, 1) << "codes of 10 bits: " << where;
}

/// Alpha is straight in videos, linear and of full range, and multiplied after decoding.
TEST_F(Clips, AlphaIsMultipliedInLight) {
  const auto movie = open(clip("alpha.mov", "-c:v qtrle -pix_fmt argb", 2, true));
  ASSERT_TRUE(movie);
  const auto picture = read(movie, 0).value();
  ASSERT_TRUE(picture.has_alpha);
  const int x = 100, y = 60;
  const double alpha = std::round(255 * (x + 0.5) / kClipWidth) / 255;
  EXPECT_NEAR(picture.color.at(x, y)[3], alpha, 1e-6);
  const double u = (x + 3.0) / 40, v = (y - 1) / 23.0;
  const double stored = std::round(255 * (0.5 + 0.4 * std::sin(u) * std::cos(v))) / 255;
  EXPECT_NEAR(picture.color.at(x, y)[0], alpha * std::pow((stored + 0.055) / 1.055, 2.4), 1e-5);
}

/// A clip of one colour in 10 bits of full range, by the numbers of Y, Cb and Cr.
class Matrices : public Clips {
 protected:
  std::string clip(const std::string& name, std::array<double, 3> ycc, const std::string& tags) {
    std::ofstream raw(path("colour.raw"), std::ios::binary);
    for (int plane = 0; plane < 3; ++plane) {
      const int code = static_cast<int>(std::lround((ycc[static_cast<std::size_t>(plane)] + (plane ? 0.5 : 0)) * 1023));
      for (int i = 0; i < 32 * 32; ++i) raw.put(static_cast<char>(code & 255)).put(static_cast<char>(code >> 8));
    }
    raw.close();
    ffmpeg(fmt::format("-f rawvideo -pix_fmt yuv444p10le -s 32x32 -color_range pc -i '{}' {} -c:v ffv1 -level 3 '{}'",
                       path("colour.raw"), tags, path(name)));
    return path(name);
  }
};

/// H.273, matrix 12: weights of light are those of the primaries, here of P3.
TEST_F(Matrices, OfPrimariesIsRead) {
  const double kr = 0.22897456, kb = 0.07928691, r = 0.8, g = 0.3, b = 0.5;
  const double y = kr * r + (1 - kr - kb) * g + kb * b;
  const auto movie = open(clip("derived.mkv", {y, (b - y) / (2 * (1 - kb)), (r - y) / (2 * (1 - kr))},
                               tags_of("chroma-derived-nc", "pc", "smpte432", "iec61966-2-1")));
  ASSERT_TRUE(movie);
  EXPECT_THAT(movie->facts().warnings, testing::IsEmpty());
  std::vector<float> row(32 * 3);
  std::vector<ReadTarget> targets;
  for (int channel = 0; channel < 3; ++channel) targets.push_back({channel, row.data() + channel, 3, 0});
  const auto read = Movie::frame(movie, 0)->read(0, targets);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_NEAR(row[0], r, 2e-3);
  EXPECT_NEAR(row[1], g, 2e-3);
  EXPECT_NEAR(row[2], b, 2e-3);
}

/// Their luma is made of light: RGB by a matrix alone would have other greys.
TEST_F(Matrices, WithoutRgbAreRefused) {
  for (const auto& [matrix, transfer, number] :
       {std::tuple("bt2020c", "bt2020-10", 10), {"chroma-derived-c", "bt709", 13}, {"smpte2085", "smpte2084", 11}}) {
    const std::string file = clip("refused.mkv", {0.5, 0, 0}, tags_of(matrix, "pc", "bt2020", transfer));
    const auto movie = try_open(file);
    ASSERT_FALSE(movie) << matrix;
    EXPECT_THAT(movie.error().message, testing::HasSubstr("is stored by a matrix that is not read")) << matrix;
    EXPECT_THAT(movie.error().message, testing::HasSubstr(fmt::format("number {} of H.273", number)));
  }
}

/// Grey that says neither matrix nor range is full, as for FFmpeg; what says one of them is held to it.
TEST_F(Clips, PlainGreyIsOfFullRange) {
  constexpr int kWidth = 64;
  const auto stored = [&](const std::string& file, int x) {
    const auto movie = open(file);
    if (!movie) return -1.0;
    std::vector<float> row(std::size_t{kWidth} * 2 * 3);
    std::vector<ReadTarget> targets;
    for (int channel = 0; channel < 3; ++channel) targets.push_back({channel, row.data() + channel, 3, kWidth * 3});
    const auto read = Movie::frame(movie, 0)->read(0, targets);
    EXPECT_TRUE(read) << read.error().text();
    return static_cast<double>(row[static_cast<std::size_t>(x) * 3]);
  };
  struct Kind {
    const char *pixels, *file, *options;
    bool full;
  };
  for (const Kind& kind : {Kind{"gray", "a.avi", "-c:v rawvideo", true},
                           {"gray", "a.nut", "-c:v rawvideo", true},
                           {"gray10le", "b.nut", "-c:v rawvideo", true},
                           {"gray16le", "c.nut", "-c:v rawvideo", true},
                           {"ya8", "d.nut", "-c:v rawvideo", true},
                           {"gray", "e.mkv", "-c:v ffv1", true},
                           {"gray", "f.y4m", "", true},
                           {"gray", "g.y4m", "-color_range tv", false},
                           {"gray", "h.y4m", "-color_range pc", true},
                           {"gray", "i.mkv", "-c:v ffv1 -color_range tv", false},
                           {"gray", "j.mkv", "-c:v ffv1 -colorspace bt709", false}}) {
    const std::string_view pixels = kind.pixels;
    const int bits = pixels == "gray10le" ? 10 : pixels == "gray16le" ? 16 : 8;
    std::ofstream raw(path("grey.raw"), std::ios::binary);
    for (int i = 0; i < kWidth * 2; ++i) {
      const int code = i % kWidth << (bits - 6);
      raw.put(static_cast<char>(code & 255));
      if (bits > 8) raw.put(static_cast<char>(code >> 8));
      if (pixels == "ya8") raw.put(static_cast<char>(255));
    }
    raw.close();
    ffmpeg(fmt::format("-f rawvideo -pix_fmt {0} -s {1}x2 -i '{2}' {3} -pix_fmt {0} '{4}'", pixels, kWidth,
                       path("grey.raw"), kind.options, path(kind.file)));
    const double most = (1 << bits) - 1, scale = 1 << (bits - 8);
    for (const int x : {0, 2, 30, 63}) {
      const double code = x << (bits - 6);
      const double expected = kind.full ? code / most : (code / scale - 16) / 219;
      EXPECT_NEAR(stored(path(kind.file), x), expected, 1e-5) << kind.file << " " << pixels << " at " << x;
    }
  }
}

/// Codes of a palette are that palette's colours, and its alpha: as in a still picture of the same codes.
TEST_F(Clips, PalettesAreLookedUp) {
  const auto palette = [&](const char* name, const char* codec) {
    return clip(name, fmt::format("-filter_complex '[0]split[a][b];[a]palettegen[p];[b][p]paletteuse' {}", codec), 2,
                true);
  };
  Diagnostics quiet;
  const auto still = read_picture(palette("still.png", "-frames:v 1 -update 1"), {}, quiet);
  ASSERT_TRUE(still) << still.error().text();
  for (const auto& [name, codec] : {std::pair("png.mov", "-c:v png"), std::pair("raw.nut", "-c:v rawvideo")}) {
    const auto movie = open(palette(name, codec));
    ASSERT_TRUE(movie);
    EXPECT_EQ(movie->facts().pixel_format, "pal8") << name;
    const auto picture = read(movie, 0).value();
    ASSERT_TRUE(picture.has_alpha);
    double worst = 0;
    for (int y = 0; y < kClipHeight; ++y)
      for (int x = 0; x < kClipWidth; ++x)
        for (std::size_t c = 0; c < 4; ++c)
          worst = std::max(worst, std::abs(static_cast<double>(picture.color.at(x, y)[c]) - still->color.at(x, y)[c]));
    EXPECT_LE(worst, 1e-6) << name;
  }
}

/// zimg takes whole samples of chroma alone.
TEST_F(Clips, OddSidesAreReadWhole) {
  for (const char* pixels : {"yuv420p", "yuv422p10le", "yuv410p", "yuva420p"}) {
    const std::string file = path(fmt::format("odd_{}.mkv", pixels));
    ffmpeg(fmt::format(
        "-f lavfi -i testsrc2=s=67x43:d=0.1 -vf format=rgb24,scale=67:43,setsar=1 -c:v ffv1 -level 3 -pix_fmt {} '{}'",
        pixels, file));
    const auto movie = open(file);
    ASSERT_TRUE(movie);
    const auto picture = read(movie, 0);
    ASSERT_TRUE(picture) << picture.error().text();
    EXPECT_EQ(picture->color.size(), (Size{67, 43}));
    ffmpeg(
        fmt::format("-i '{}' -frames:v 1 -vf "
                    "scale=out_range=pc:flags=bilinear+accurate_rnd+full_chroma_int,format=gbrp -f rawvideo '{}'",
                    file, path("odd.raw")));
    const std::string bytes = read_file(path("odd.raw")).value();
    // Luma alone: the corner pixel's green follows it within a few codes.
    const auto green = static_cast<std::uint8_t>(bytes[67 * 43 - 1]) / 255.0;
    const double light = green < 0.081 ? green / 4.5 : std::pow((green + 0.099) / 1.099, 1 / 0.45);
    EXPECT_NEAR(picture->color.at(66, 42)[1], light, 0.08) << pixels;
  }
}

}  // namespace
}  // namespace afterglow
