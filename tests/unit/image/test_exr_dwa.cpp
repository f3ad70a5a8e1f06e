// SPDX-License-Identifier: MIT
// DWAA and DWAB as they are packed here, against OpenEXR's own: read by it, as near to the picture, as short.
#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gtest/gtest.h>
#include <half.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>

#include "image/exr_dct.h"
#include "image/exr_dwa.h"
#include "image/exr_line_writer.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {

using Imath::half;

float value_of(unsigned bits) {
  half value;
  value.setBits(static_cast<std::uint16_t>(bits));
  return value;
}

/// A, B, G, R, one plane behind the other; or without A.
struct Planes {
  int width, height;
  bool has_alpha;
  std::vector<half> samples;

  std::string names() const { return has_alpha ? "ABGR" : "BGR"; }
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

using Fill = std::function<float(char channel, int x, int y)>;

Planes planes(int width, int height, bool has_alpha, const Fill& fill) {
  Planes out{width, height, has_alpha, {}};
  for (const char name : out.names())
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) out.samples.emplace_back(fill(name, x, y));
  return out;
}

Imf::Header header_of(const Planes& picture, Imf::Compression compression, float level) {
  const Imath::Box2i window({-3, 7}, {picture.width - 4, picture.height + 6});
  Imf::Header header(window, window);
  header.compression() = compression;
  header.dwaCompressionLevel() = level;
  for (const char name : picture.names()) header.channels().insert(std::string(1, name), Imf::Channel(Imf::HALF));
  return header;
}

void write_here(const Planes& picture, const Imf::Header& header, const std::filesystem::path& file) {
  OutputFile out(file);
  ExrLineWriter writer(header, out);
  writer.write(picture.height, [&](int y, std::uint8_t* line) {
    const auto width = static_cast<std::size_t>(picture.width);
    for (std::size_t c = 0; c < picture.names().size(); ++c)
      std::memcpy(line + 2 * width * c, &picture.samples[c * picture.pixels() + static_cast<std::size_t>(y) * width],
                  2 * width);
  });
  writer.finish();
  ASSERT_TRUE(out.close());
}

Imf::FrameBuffer buffer_of(Planes& picture, const Imath::Box2i& window) {
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < picture.names().size(); ++c)
    buffer.insert(std::string(1, picture.names()[c]),
                  Imf::Slice::Make(Imf::HALF, &picture.samples[c * picture.pixels()], window, sizeof(half),
                                   sizeof(half) * static_cast<std::size_t>(picture.width)));
  return buffer;
}

void write_by_openexr(Planes picture, const Imf::Header& header, const std::filesystem::path& file) {
  Imf::OutputFile out(file.c_str(), header);
  out.setFrameBuffer(buffer_of(picture, header.dataWindow()));
  out.writePixels(picture.height);
}

Planes read_by_openexr(const Planes& like, const std::filesystem::path& file) {
  Imf::InputFile in(file.c_str());
  EXPECT_TRUE(in.isComplete());
  Planes out{like.width, like.height, like.has_alpha, std::vector<half>(like.samples.size())};
  in.setFrameBuffer(buffer_of(out, in.header().dataWindow()));
  in.readPixels(in.header().dataWindow().min.y, in.header().dataWindow().max.y);
  return out;
}

/// Root mean square, in what DWA calls even steps, of colour; alpha must be the same.
double error_of(const Planes& picture, const Planes& read) {
  double sum = 0;
  const std::size_t first = picture.has_alpha ? picture.pixels() : 0;
  for (std::size_t i = 0; i < first; ++i) EXPECT_EQ(picture.samples[i].bits(), read.samples[i].bits()) << "alpha " << i;
  for (std::size_t i = first; i < picture.samples.size(); ++i) {
    const double off = dwa_curve()[picture.samples[i].bits()] - dwa_curve()[read.samples[i].bits()];
    sum += off * off;
  }
  return std::sqrt(sum / static_cast<double>(picture.samples.size() - first));
}

float uniform(std::mt19937& random) { return static_cast<float>(random() >> 8) / (1 << 24); }

/// What renderers make: slopes, edges, light of many sizes, a little noise; alpha with an edge.
Planes rendered(int width, int height, bool has_alpha) {
  std::mt19937 random(5);
  return planes(width, height, has_alpha, [&](char channel, int x, int y) {
    if (channel == 'A') return x * 3 > y * 2 ? 1.0f : x % 7 == 0 ? uniform(random) : 0.0f;
    const float slope = 0.3f + 0.2f * std::sin(static_cast<float>(x + channel) / 40) + 0.001f * static_cast<float>(y);
    const float lamp = (x / 50 + y / 40) % 5 == 0 ? 12.0f : (x / 9 + y / 30) % 4 == 0 ? 0.02f : 1.0f;
    return slope * lamp * (0.95f + 0.1f * uniform(random));
  });
}

TEST(ExrDwa, IsAsNearAndAsShortAsOpenExr) {
  const TemporaryFolder folder;
  for (const auto compression : {Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION})
    for (const bool has_alpha : {false, true})
      for (const float level : {5.0f, 45.0f, 300.0f}) {
        const Planes picture = rendered(500, 290, has_alpha);
        const Imf::Header header = header_of(picture, compression, level);
        ASSERT_TRUE(can_pack_lines(header));
        std::filesystem::remove(folder / "here.exr");
        write_here(picture, header, folder / "here.exr");
        write_by_openexr(picture, header, folder / "openexr.exr");
        const double here = error_of(picture, read_by_openexr(picture, folder / "here.exr"));
        const double openexr = error_of(picture, read_by_openexr(picture, folder / "openexr.exr"));
        EXPECT_LE(here, 1.02 * openexr) << level;
        EXPECT_LE(static_cast<double>(std::filesystem::file_size(folder / "here.exr")),
                  1.02 * static_cast<double>(std::filesystem::file_size(folder / "openexr.exr")))
            << level << has_alpha;
      }
}

TEST(ExrDwa, PicturesOfEverySizeAreReadByOpenExr) {
  const TemporaryFolder folder;
  for (const auto compression : {Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION})
    for (const bool has_alpha : {false, true})
      for (const Imath::V2i& size :
           {Imath::V2i(1, 1), {1, 40}, {3, 2}, {8, 8}, {9, 33}, {15, 257}, {16, 7}, {300, 31}}) {
        const Planes picture = rendered(size.x, size.y, has_alpha);
        std::filesystem::remove(folder / "here.exr");
        write_here(picture, header_of(picture, compression, 45), folder / "here.exr");
        EXPECT_LE(error_of(picture, read_by_openexr(picture, folder / "here.exr")), 0.01) << size.x << "x" << size.y;
      }
}

TEST(ExrDwa, HoldsEveryHalfFloat) {
  const TemporaryFolder folder;
  std::mt19937 random(9);
  // Each alone in its block: of equal values only the mean is kept, in a half float; its steps are what is lost.
  const Planes picture = planes(8 * 64, 8 * 512, false, [&](char channel, int x, int y) {
    const unsigned bits = static_cast<unsigned>((x / 8 + y / 8 * 64) * 2 + (channel == 'G' ? 1 : 0));
    return value_of(bits);
  });
  write_here(picture, header_of(picture, Imf::DWAA_COMPRESSION, 0), folder / "here.exr");
  const Planes read = read_by_openexr(picture, folder / "here.exr");
  for (std::size_t i = 0; i < picture.samples.size(); ++i) {
    const float wanted = dwa_curve()[picture.samples[i].bits()], got = dwa_curve()[read.samples[i].bits()];
    ASSERT_NEAR(wanted, got, 0.02f) << picture.samples[i];
  }
}

TEST(ExrDwa, NoiseThatGetsLongerIsStoredAsItIs) {
  const TemporaryFolder folder;
  std::mt19937 random(2);
  const Planes picture = planes(64, 32, true, [&](char, int, int) {
    return std::ldexp(uniform(random) - 0.5f, static_cast<int>(random() % 30) - 15);
  });
  write_here(picture, header_of(picture, Imf::DWAA_COMPRESSION, 0), folder / "here.exr");
  const Planes read = read_by_openexr(picture, folder / "here.exr");
  for (std::size_t i = 0; i < picture.samples.size(); ++i) ASSERT_EQ(picture.samples[i].bits(), read.samples[i].bits());
}

TEST(ExrDwa, LeavesOtherChannelsToOpenExr) {
  const Planes picture = rendered(9, 9, false);
  Imf::Header header = header_of(picture, Imf::DWAA_COMPRESSION, 45);
  EXPECT_TRUE(has_dwa_lines(header));
  header.channels().insert("Z", Imf::Channel(Imf::HALF));
  EXPECT_FALSE(can_pack_lines(header));
  header = header_of(picture, Imf::DWAA_COMPRESSION, 45);
  header.channels().insert("A", Imf::Channel(Imf::FLOAT));
  EXPECT_FALSE(can_pack_lines(header));
  header = header_of(picture, Imf::DWAA_COMPRESSION, 45);
  header.channels().insert("R", Imf::Channel(Imf::HALF, 2, 2));
  EXPECT_FALSE(can_pack_lines(header));
}

/// By trying every half float.
std::uint16_t few_bits_by_search(float value, float tolerance) {
  std::uint16_t best = half(value).bits();
  int fewest = 99;
  float nearest = 0;
  for (unsigned bits = 0; bits < 0x7c00; ++bits) {
    const float off = std::abs(value_of(bits) - std::abs(value));
    if (off > tolerance) continue;
    const int set = std::popcount(bits);
    if (set > fewest || (set == fewest && off >= nearest)) continue;
    fewest = set;
    nearest = off;
    best = static_cast<std::uint16_t>(bits | (bits != 0 && value < 0 ? 0x8000 : 0));
  }
  return best;
}

TEST(ExrDwa, RoundsToTheFewestBits) {
  std::mt19937 random(1);
  for (int i = 0; i < 3000; ++i) {
    // Differences of both are exact, so that the search and the rule agree on what is within the tolerance.
    const float value = value_of(random() % 0x5000) * (i % 2 == 0 ? 1.0f : -1.0f);
    const float tolerance = value_of(random() % (i % 5 == 0 ? 1 : 0x4000));
    ASSERT_EQ(with_few_bits(value, tolerance), few_bits_by_search(value, tolerance)) << value << " ± " << tolerance;
  }
}

TEST(ExrDwa, VectorsMakeTheSameBits) {
  std::mt19937 random(4);
  for (const float level : {0.0f, 45.0f, 4000.0f}) {
    const DctEncoder plain(level, false), vectors(level);
    for (int i = 0; i < 500; ++i) {
      DctBlock a;
      for (auto& channel : a)
        for (float& value : channel)
          value = std::ldexp(uniform(random) - 0.3f, static_cast<int>(random() % (1 + i % 9)) - 5);
      DctBlock b = a;
      std::array<std::uint16_t, 200> ac_a{}, ac_b{};
      std::array<std::uint16_t, 3> dc_a{}, dc_b{};
      const auto size_a = plain.run(a, ac_a.data(), dc_a) - ac_a.data();
      const auto size_b = vectors.run(b, ac_b.data(), dc_b) - ac_b.data();
      ASSERT_EQ(size_a, size_b);
      ASSERT_LE(size_a, 189);
      ASSERT_EQ(ac_a, ac_b);
      ASSERT_EQ(dc_a, dc_b);
    }
  }
}

}  // namespace
}  // namespace afterglow
