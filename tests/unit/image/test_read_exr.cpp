// SPDX-License-Identifier: MIT
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "image/color_matrix.h"
#include "make_files.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {
using testing::HasSubstr;

TEST(ReadExr, BlendersNamesAndPlainNamesGiveTheSamePicture) {
  ReadOptions options;
  options.auxiliary = {"depth", "normal"};
  const Picture native = read_or_fail(test_image("blender/native.exr"), options),
                flat = read_or_fail(test_image("blender/flat.exr"), options);
  EXPECT_EQ(native.color.size(), (Size{96, 54}));
  EXPECT_EQ(native.color.pixels, flat.color.pixels);
  EXPECT_EQ(native.auxiliary.at("depth").pixels, flat.auxiliary.at("depth").pixels);
  const auto &a = native.auxiliary.at("normal").pixels, &b = flat.auxiliary.at("normal").pixels;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], 6e-4);  // rounded to half
  EXPECT_TRUE(native.has_alpha);
}

TEST(ReadExr, SameSamplesAsOpenImageIo) {
  const auto file = test_image("neon.exr");
  ReadOptions options;
  options.auxiliary = {"depth"};
  const Picture picture = read_or_fail(file, options);
  const auto input = OIIO::ImageInput::open(file.string());
  std::vector<float> all(static_cast<std::size_t>(1280) * 720 * 8);
  ASSERT_TRUE(input->read_image(0, 0, 0, 8, OIIO::TypeFloat, all.data()));
  std::uint64_t negatives = 0;
  for (std::size_t i = 0; i < all.size() / 8; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      negatives += all[i * 8 + c] < 0;
      ASSERT_EQ(picture.color.pixels[i * 4 + c], std::max(all[i * 8 + c], 0.0f));
    }
    ASSERT_EQ(picture.color.pixels[i * 4 + 3], all[i * 8 + 3]);
    ASSERT_EQ(picture.auxiliary.at("depth").pixels[i], all[i * 8 + 4]);
  }
  EXPECT_EQ(picture.sanitized.negative, negatives);
  EXPECT_GT(negatives, 0u);
}

TEST(ReadExr, TheFrameIsReadWithOverscanAndWithoutWhatIsMissing) {
  const Picture inside = read_or_fail(test_image("openexr/DisplayWindow_t03.exr"));
  EXPECT_EQ(inside.data_window, (Rect{0, 0, 400, 300}));
  EXPECT_EQ(inside.display_window, (Rect{30, 20, 370, 280}));
  const Picture across = read_or_fail(test_image("openexr/DisplayWindow_t08.exr"));
  EXPECT_EQ(across.data_window, (Rect{0, 0, 501, 401}));  // its own is 400×300 at 30, 40
  EXPECT_EQ(across.display_window, (Rect{0, 0, 501, 401}));
  for (int y = 0; y < 401; ++y)
    for (int x = 0; x < 501; ++x) {
      const bool there = x >= 30 && x < 430 && y >= 40 && y < 340;
      const float nothing[4] = {0, 0, 0, across.has_alpha ? 0.0f : 1.0f};
      ASSERT_TRUE(std::equal(across.color.at(x, y), across.color.at(x, y) + 4,
                             there ? inside.color.at(x - 30, y - 40) : nothing))
          << x << " " << y;
    }
}

TEST(ReadExr, FirstMipLevel) {
  const Picture picture = read_or_fail(test_image("openexr/MultiResolution_ColorCodedLevels.exr"));
  EXPECT_EQ(picture.color.size(), (Size{512, 512}));
  const auto input = OIIO::ImageInput::open(test_image("openexr/MultiResolution_ColorCodedLevels.exr").string());
  std::vector<float> level(512 * 512 * 4);
  ASSERT_TRUE(input->read_image(0, 0, 0, 4, OIIO::TypeFloat, level.data()));
  EXPECT_EQ(picture.color.pixels, level);
}

TEST(ReadExr, GreyIsSpread) {
  const Picture picture = read_or_fail(test_image("openexr/TestImages_GrayRampsHorizontal.exr"));
  for (std::size_t i = 0; i < picture.color.pixels.size(); i += 4) {
    ASSERT_EQ(picture.color.pixels[i], picture.color.pixels[i + 1]);
    ASSERT_EQ(picture.color.pixels[i], picture.color.pixels[i + 2]);
    ASSERT_EQ(picture.color.pixels[i + 3], 1);
  }
  EXPECT_FALSE(picture.has_alpha);
  EXPECT_NEAR(*std::max_element(picture.color.pixels.begin(), picture.color.pixels.end()), 18, 0.1);
}

TEST(ReadExr, LuminanceChroma) {
  const Picture picture = read_or_fail(test_image("openexr/Chromaticities_Rec709_YC.exr"));
  EXPECT_EQ(picture.color.size(), (Size{610, 406}));
  float largest = 0;
  double red = 0, blue = 0;
  for (std::size_t i = 0; i < picture.color.pixels.size(); i += 4) {
    for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, picture.color.pixels[i + c]);
    red += picture.color.pixels[i];
    blue += picture.color.pixels[i + 2];
  }
  EXPECT_NEAR(largest, 8.164, 0.01);  // what OpenEXR's own RgbaInputFile gives
  EXPECT_GT(red, 2 * blue);
}

TEST(ReadExr, PartsAndLayers) {
  const TemporaryFolder folder;
  const auto file = folder / "parts.exr";
  auto beauty = make_spec(6, 5, {"R", "G", "B", "A"}, OIIO::TypeHalf), depth = make_spec(6, 5, {"Z"}, OIIO::TypeFloat),
       extra = make_spec(6, 5, {"diffuse.R", "diffuse.G", "diffuse.B", "spec.R", "spec.G", "spec.B"}, OIIO::TypeHalf);
  beauty.attribute("oiio:subimagename", "rgba");
  depth.attribute("oiio:subimagename", "depth");
  extra.attribute("oiio:subimagename", "extra");
  ASSERT_NO_FATAL_FAILURE(
      make_file(file, {extra, depth, beauty}, {marks(6, 5, 6), std::vector<float>(30, 7.5f), marks(6, 5, 4)}));
  ReadOptions options;
  options.auxiliary = {"depth", "normal"};
  Picture picture = read_or_fail(file, options);
  EXPECT_EQ(picture.color.at(3, 2)[0], mark(3, 2, 0));
  EXPECT_EQ(picture.color.at(3, 2)[3], mark(3, 2, 3));
  EXPECT_EQ(picture.auxiliary.at("depth").pixels, std::vector<float>(30, 7.5f));
  EXPECT_EQ(picture.auxiliary.count("normal"), 0u);
  options.layer = "spec";
  picture = read_or_fail(file, options);
  EXPECT_EQ(picture.color.at(3, 2)[0], mark(3, 2, 3));
  EXPECT_EQ(picture.color.at(3, 2)[3], 1);
  options.layer = "spcc";
  Diagnostics silent;
  const auto wrong = read_picture(file, options, silent);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().kind, ErrorKind::io);
  EXPECT_EQ(wrong.error().file, file.string());
  EXPECT_EQ(wrong.error().nearest, "spec");
}

TEST(ReadExr, UintChannelsArePlainNumbers) {
  const TemporaryFolder folder;
  const std::vector<std::uint32_t> samples{0, 1, 70000, 4000000000u};
  Imf::Header header(2, 2);
  Imf::FrameBuffer buffer;
  for (const char* name : {"R", "G", "B"}) {
    header.channels().insert(name, Imf::Channel(Imf::UINT));
    buffer.insert(name,
                  Imf::Slice(Imf::UINT, reinterpret_cast<char*>(const_cast<std::uint32_t*>(samples.data())), 4, 8));
  }
  {
    Imf::OutputFile out((folder / "u.exr").c_str(), header);
    out.setFrameBuffer(buffer);
    out.writePixels(2);
  }
  const Picture picture = read_or_fail(folder / "u.exr");
  for (int i = 0; i < 4; ++i)
    EXPECT_EQ(picture.color.at(i % 2, i / 2)[1], static_cast<float>(samples[static_cast<std::size_t>(i)]));
}

TEST(ReadExr, EveryCompression) {
  const TemporaryFolder folder;
  for (const char* compression : {"none", "rle", "zip", "zips", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"}) {
    OIIO::ImageSpec spec = make_spec(45, 33, {"R", "G", "B"}, OIIO::TypeHalf);
    spec.attribute("compression", compression);
    std::vector<float> flat(45 * 33 * 3, 0.5f);
    ASSERT_NO_FATAL_FAILURE(make_file(folder / "c.exr", {spec}, {flat}));
    const Picture picture = read_or_fail(folder / "c.exr");
    for (const float v : picture.color.pixels) ASSERT_NEAR(v, v == 1 ? 1 : 0.5, 2e-3) << compression;
  }
}

/// Lines of ZIP are unpacked, spread and decoded here, those of others by OpenEXR: the same bits of every channel.
TEST(ReadExr, ZippedLinesAreThoseOfOtherCompressions) {
  const TemporaryFolder folder;
  const std::vector<std::vector<std::string>> sets = {
      {"R", "G", "B"}, {"R", "G", "B", "A"}, {"Y"}, {"G"}, {"R", "G"}, {"B", "G", "R", "Z"}, {"Z", "R", "A", "B", "G"}};
  for (const auto& names : sets)
    for (const Size size : {Size{1, 1}, Size{3, 17}, Size{4, 16}, Size{9, 33}})
      for (const auto& type : {OIIO::TypeHalf, OIIO::TypeFloat}) {
        std::vector<float> samples(static_cast<std::size_t>(size.area()) * names.size());
        for (std::size_t i = 0; i < samples.size(); ++i)
          samples[i] = i % 13 == 5 ? NAN : i % 17 == 3 ? -1.5f : i % 29 == 11 ? INFINITY : 0.25f * float(i % 41);
        const auto read = [&](const char* compression) {
          OIIO::ImageSpec spec = make_spec(size.width, size.height, names, type);
          spec.attribute("compression", compression);
          make_file(folder / "c.exr", {spec}, {samples});
          ReadOptions options;
          options.auxiliary = {"depth"};
          return read_or_fail(folder / "c.exr", options);
        };
        const Picture plain = read("none");
        for (const char* compression : {"zip", "zips"}) {
          const Picture zipped = read(compression);
          const auto what = testing::Message() << compression << " " << names.size() << " " << size.width;
          EXPECT_EQ(zipped.color.pixels, plain.color.pixels) << what;
          EXPECT_EQ(zipped.sanitized.nan, plain.sanitized.nan) << what;
          EXPECT_EQ(zipped.sanitized.negative, plain.sanitized.negative) << what;
          ASSERT_EQ(zipped.non_finite.size(), plain.non_finite.size()) << what;
          for (const auto& [layer, found] : plain.non_finite)
            EXPECT_EQ(zipped.non_finite.at(layer).first->text(), found.first->text()) << what << layer;
          ASSERT_EQ(zipped.auxiliary.size(), plain.auxiliary.size());
          for (const auto& [name, image] : plain.auxiliary)
            EXPECT_EQ(zipped.auxiliary.at(name).pixels, image.pixels) << what;
        }
      }
}

/// A half RGB file with an attribute or two more.
void make_exr(const std::filesystem::path& file, const std::vector<float>& rgb, int width, int height,
              const std::function<void(Imf::Header&)>& edit) {
  Imf::Header header(width, height);
  edit(header);
  Imf::FrameBuffer buffer;
  const Imath::Box2i window = header.dataWindow();
  for (int c = 0; c < 3; ++c) {
    const char name[2] = {"RGB"[c], 0};
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, rgb.data() + c, window, 12, 12 * static_cast<std::size_t>(width)));
  }
  Imf::OutputFile out(file.c_str(), header);
  out.setFrameBuffer(buffer);
  out.writePixels(height);
}

TEST(ReadExr, PrimariesAreConverted) {
  const TemporaryFolder folder;
  const Imf::Chromaticities ap1({0.713f, 0.293f}, {0.165f, 0.830f}, {0.128f, 0.044f}, {0.32168f, 0.33767f});
  make_exr(folder / "ap1.exr", {0.5f, 0.5f, 0.5f, 0.2f, 0.6f, 0.3f}, 2, 1,
           [&](Imf::Header& h) { Imf::addChromaticities(h, ap1); });
  const Picture picture = read_or_fail(folder / "ap1.exr");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.color.at(0, 0)[c], 0.5, 1e-5);
  // The published ACEScg → Rec.709 matrix.
  EXPECT_EQ(picture.color.at(1, 0)[0], 0);  // 1.70505 · 0.2 − 0.62179 · 0.6 − 0.08326 · 0.3 is below 0
  EXPECT_NEAR(picture.color.at(1, 0)[1], -0.13026 * 0.2 + 1.14080 * 0.6 - 0.01055 * 0.3, 3e-4);
  EXPECT_NEAR(picture.color.at(1, 0)[2], -0.02400 * 0.2 - 0.12897 * 0.6 + 1.15297 * 0.3, 3e-4);
}

TEST(ReadExr, Rec709PrimariesChangeNothing) {
  const TemporaryFolder folder;
  const std::vector<float> rgb{0.1f, 0.7f, 13.37f};
  make_exr(folder / "a.exr", rgb, 1, 1, [](Imf::Header& h) { Imf::addChromaticities(h, Imf::Chromaticities()); });
  const Picture picture = read_or_fail(folder / "a.exr");
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(picture.color.pixels[c], rgb[c]);
}

TEST(ReadExr, NonsensePrimariesAreWarnedAbout) {
  const TemporaryFolder folder;
  make_exr(folder / "a.exr", {1, 2, 3}, 1, 1, [](Imf::Header& h) {
    Imf::addChromaticities(h, Imf::Chromaticities({0, 0}, {0, 0}, {0, 0}, {0, 0}));
  });
  Messages messages;
  const auto picture = read_picture(folder / "a.exr", {}, messages.diagnostics);
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture.value().color.pixels[2], 3);
  ASSERT_EQ(messages.warnings.size(), 1u);
  EXPECT_THAT(messages.warnings[0], HasSubstr("chromaticities"));
}

TEST(ReadExr, WindowsFarApartAreNotJoined) {
  const TemporaryFolder folder;
  make_exr(folder / "a.exr", std::vector<float>(3 * 6, 1), 3, 2, [](Imf::Header& h) {
    h.dataWindow() = {{5000, 0}, {5002, 1}};
    h.displayWindow() = {{0, 0}, {9, 4}};
  });
  EXPECT_EQ(read_or_fail(folder / "a.exr").data_window, (Rect{5000, 0, 3, 2}));
}

/// Also where nothing of the picture is inside: an object that has left its frame.
TEST(ReadExr, CutOverscanLeavesTheFrame) {
  const TemporaryFolder folder;
  for (const Imath::V2i& at : {Imath::V2i(-1, 1), Imath::V2i(12, 2), Imath::V2i(5000, 4000)}) {
    make_exr(folder / "a.exr", std::vector<float>(3 * 6, 1), 3, 2, [&](Imf::Header& h) {
      h.dataWindow() = {at, at + Imath::V2i(2, 1)};
      h.displayWindow() = {{0, 0}, {9, 4}};
    });
    ReadOptions options;
    options.cut_overscan = true;
    Messages messages;
    const auto picture = read_picture(folder / "a.exr", options, messages.diagnostics);
    ASSERT_TRUE(picture) << picture.error().text();
    EXPECT_EQ(picture->data_window, (Rect{0, 0, 10, 5}));
    EXPECT_EQ(picture->color.at(0, 1)[0], at.x == -1 ? 1 : 0);
    EXPECT_EQ(picture->color.at(9, 4)[0], 0);
    EXPECT_TRUE(messages.warnings.empty());
    EXPECT_EQ(read_header(folder / "a.exr", options)->data_window, picture->data_window);
  }
}

TEST(ReadExr, OrientationTurnsPixelsAndWindows) {
  const TemporaryFolder folder;
  const std::vector<float> rgb{1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5, 5, 6, 6, 6};  // 3 × 2
  make_exr(folder / "a.exr", rgb, 3, 2, [](Imf::Header& h) {
    h.dataWindow() = {{1, 0}, {3, 1}};
    h.displayWindow() = {{0, 0}, {9, 4}};
    h.insert("Orientation", Imf::IntAttribute(6));  // a quarter turn clockwise makes it upright
  });
  const Picture picture = read_or_fail(folder / "a.exr");
  EXPECT_EQ(picture.display_window.size(), (Size{5, 10}));
  EXPECT_EQ(picture.data_window, picture.display_window);
  EXPECT_EQ(picture.color.at(3, 1)[0], 4);  // the bottom-left pixel goes to the top left
  EXPECT_EQ(picture.color.at(4, 1)[0], 1);
  EXPECT_EQ(picture.color.at(4, 3)[0], 3);
  EXPECT_EQ(picture.color.at(2, 1)[0], 0);
  const auto header = read_header(folder / "a.exr", {});
  EXPECT_EQ(header.value().data_window, picture.data_window);
  EXPECT_EQ(header.value().display_window, picture.display_window);
}

TEST(ReadExr, NotFiniteIsMendedCountedAndSaidOnce) {
  const TemporaryFolder folder;
  make_exr(folder / "a.exr", {NAN, -1, INFINITY, 1, -INFINITY, 5}, 2, 1, [](Imf::Header&) {});
  Messages messages;
  const auto picture = read_picture(folder / "a.exr", {}, messages.diagnostics);
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture.value().color.pixels, (std::vector<float>{0, 0, 1e30f, 1, 1, 0, 5, 1}));
  EXPECT_EQ(picture.value().sanitized.nan, 1u);
  EXPECT_EQ(picture.value().sanitized.negative, 2u);
  EXPECT_EQ(picture.value().sanitized.too_large, 1u);
  ASSERT_EQ(messages.warnings.size(), 1u);
  EXPECT_THAT(messages.warnings[0], HasSubstr("1 NaN"));
}

TEST(ReadExr, NegativesAloneAreANoteUnlessTheyAreLarge) {
  const TemporaryFolder folder;
  make_exr(folder / "a.exr", {-0.009f, 1, 1}, 1, 1, [](Imf::Header&) {});
  make_exr(folder / "b.exr", {-0.02f, 1, 1}, 1, 1, [](Imf::Header&) {});
  Messages messages, others;
  ASSERT_TRUE(read_picture(folder / "a.exr", {}, messages.diagnostics));
  EXPECT_TRUE(messages.warnings.empty());
  EXPECT_EQ(messages.notes.size(), 1u);
  ASSERT_TRUE(read_picture(folder / "b.exr", {}, others.diagnostics));
  ASSERT_EQ(others.warnings.size(), 1u);
  EXPECT_THAT(others.warnings[0], HasSubstr("1 samples are below -0.01"));
}

TEST(ReadExr, DeepIsRefused) {
  const TemporaryFolder folder;
  Imf::Header header(2, 2);
  header.channels().insert("R", Imf::Channel(Imf::HALF));
  header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  header.setType(Imf::DEEPSCANLINE);
  header.compression() = Imf::ZIPS_COMPRESSION;
  {
    Imf::DeepScanLineOutputFile out((folder / "deep.exr").c_str(), header);
    std::vector<unsigned> counts(4, 0);
    std::vector<half*> red(4);
    std::vector<float*> z(4);
    Imf::DeepFrameBuffer buffer;
    buffer.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), 4, 8));
    buffer.insert("R", Imf::DeepSlice(Imf::HALF, reinterpret_cast<char*>(red.data()), 8, 16, 2));
    buffer.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(z.data()), 8, 16, 4));
    out.setFrameBuffer(buffer);
    out.writePixels(2);
  }
  Diagnostics silent;
  const auto picture = read_picture(folder / "deep.exr", {}, silent);
  ASSERT_FALSE(picture);
  EXPECT_EQ(picture.error().kind, ErrorKind::io);
  EXPECT_THAT(picture.error().message, HasSubstr("deep EXR"));
}

TEST(ReadExr, HeaderTellsWhatReadingFinds) {
  ReadOptions options;
  options.auxiliary = {"depth"};
  const auto header = read_header(test_image("neon.exr"), options);
  ASSERT_TRUE(header);
  EXPECT_EQ(header.value().format, "openexr");
  EXPECT_EQ(header.value().auxiliary, (std::vector<std::string>{"depth", "normal"}));
  EXPECT_EQ(header.value().channels, 8);
  EXPECT_GE(header.value().host_bytes, 1280u * 720 * (16 + 4));
  EXPECT_LT(header.value().host_bytes, 1280u * 720 * (16 + 4) * 3);
}

}  // namespace
}  // namespace afterglow
