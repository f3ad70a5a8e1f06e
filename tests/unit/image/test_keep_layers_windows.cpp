// SPDX-License-Identifier: MIT
// Layers that are kept where a file's data window is not its frame.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "image/writer.h"
#include "make_files.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {

struct Windows {
  const char* name;
  Rect data, display;
};

class KeepLayersWindows : public testing::TestWithParam<Windows> {
 protected:
  static constexpr float kLight = 0.25F;  ///< what an "effect" adds everywhere
  static constexpr int kColors = 4;
  static inline const std::vector<std::string> kNames{"R", "G", "B", "A", "Z", "far.Z", "id.R", "id.G", "mark.u"};
  static inline const std::vector<OIIO::TypeDesc> kTypes{OIIO::TypeHalf,  OIIO::TypeHalf,  OIIO::TypeHalf,
                                                         OIIO::TypeHalf,  OIIO::TypeFloat, OIIO::TypeHalf,
                                                         OIIO::TypeFloat, OIIO::TypeFloat, OIIO::TypeUInt32};

  static OIIO::ImageSpec spec_of(const Windows& windows, int channels) {
    auto spec =
        make_spec(windows.data.width, windows.data.height, {kNames.begin(), kNames.begin() + channels}, OIIO::TypeHalf);
    spec.channelformats.assign(kTypes.begin(), kTypes.begin() + channels);
    spec.format = OIIO::TypeFloat;
    spec.x = windows.data.x, spec.y = windows.data.y;
    spec.full_x = windows.display.x, spec.full_y = windows.display.y;
    spec.full_width = windows.display.width, spec.full_height = windows.display.height;
    return spec;
  }
  /// Halves the colour and adds light to the whole frame. What was written, of its part `part`.
  struct Written {
    Picture picture;  ///< that was written
    OIIO::ImageSpec spec;
    std::vector<float> samples;
    float at(int x, int y, std::size_t channel) const {
      const auto pixel = static_cast<std::size_t>(y - spec.y) * static_cast<std::size_t>(spec.width) +
                         static_cast<std::size_t>(x - spec.x);
      return samples[pixel * static_cast<std::size_t>(spec.nchannels) + channel];
    }
  };
  Written process(const std::string& compression, int part = 0) {
    Written out{read_or_fail(folder_ / "in.exr"), {}, {}};
    for (std::size_t i = 0; i < out.picture.color.pixels.size(); ++i)
      if (i % 4 != 3) out.picture.color.pixels[i] = 0.5F * out.picture.color.pixels[i] + kLight;
    WriteOptions options;
    options.keep_layers = true;
    options.compression = compression;
    const auto written = write_picture(out.picture, folder_ / "o.exr", options, messages_.diagnostics);
    if (!written) throw std::runtime_error(written.error().text());
    const auto input = OIIO::ImageInput::open((folder_ / "o.exr").string());
    if (!input || !input->seek_subimage(part, 0)) throw std::runtime_error(OIIO::geterror());
    out.spec = input->spec();
    out.samples.resize(out.spec.image_pixels() * static_cast<std::size_t>(out.spec.nchannels));
    if (!input->read_image(part, 0, 0, out.spec.nchannels, OIIO::TypeFloat, out.samples.data()))
      throw std::runtime_error(input->geterror());
    return out;
  }
  static Rect window_of(const OIIO::ImageSpec& spec) { return {spec.x, spec.y, spec.width, spec.height}; }
  static Rect display_of(const OIIO::ImageSpec& spec) {
    return {spec.full_x, spec.full_y, spec.full_width, spec.full_height};
  }
  /// Every sample of the colour's part, but for the colour's own loss.
  static void expect_right(const Written& made, const std::vector<float>& given, const Windows& windows) {
    ASSERT_EQ(window_of(made.spec), made.picture.data_window);
    ASSERT_EQ(display_of(made.spec), windows.display);
    const Rect &frame = made.picture.data_window, &data = windows.data;
    const auto channels = static_cast<std::size_t>(made.spec.nchannels);
    for (int y = frame.y; y < frame.y + frame.height; ++y)
      for (int x = frame.x; x < frame.x + frame.width; ++x)
        for (std::size_t c = 0; c < channels; ++c) {
          const bool inside = x >= data.x && x < data.x + data.width && y >= data.y && y < data.y + data.height;
          const auto place = static_cast<std::size_t>(y - data.y) * static_cast<std::size_t>(data.width) +
                             static_cast<std::size_t>(x - data.x);
          const float was = inside ? given[place * channels + c] : 0;
          float expected = c < 3 ? 0.5F * was + kLight : was;
          if (!inside && kNames[c] == "Z") expected = 1e10F;
          if (!inside && kNames[c] == "far.Z") expected = 65504;
          const auto name = made.spec.channelnames[c];
          ASSERT_EQ(name, kNames[c]);
          ASSERT_NEAR(made.at(x, y, c), expected, c < kColors ? 1e-3F : 0) << name << " " << x << "," << y;
        }
  }
  /// Samples that each type holds as they are.
  static std::vector<float> samples_of(const Windows& windows, int channels) {
    std::vector<float> samples = marks(windows.data.width, windows.data.height, channels);
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (const auto c = i % static_cast<std::size_t>(channels); kNames[c] == "mark.u") samples[i] = 1;
    return samples;
  }
  TemporaryFolder folder_;
  Messages messages_;
};

TEST_P(KeepLayersWindows, OnePartIsPlacedInTheFrame) {
  const int channels = static_cast<int>(kNames.size());
  const auto samples = samples_of(GetParam(), channels);
  for (const char* stored : {"zip", "piz", "none", "rle"})
    for (const bool tiled : {false, true}) {
      auto spec = spec_of(GetParam(), channels);
      spec.attribute("compression", stored);
      if (tiled) spec.tile_width = spec.tile_height = 16;
      ASSERT_NO_FATAL_FAILURE(make_file(folder_ / "in.exr", {spec}, {samples}));
      for (const char* wanted : {"", "zips", "piz", "none", "rle"}) {
        SCOPED_TRACE(std::string(stored) + (tiled ? ", tiled" : "") + " to " + wanted);
        ASSERT_NO_FATAL_FAILURE(expect_right(process(wanted), samples, GetParam()));
      }
    }
  EXPECT_THAT(messages_.warnings, testing::IsEmpty());
}

TEST_P(KeepLayersWindows, ColourAlone) {
  const auto samples = samples_of(GetParam(), kColors);
  ASSERT_NO_FATAL_FAILURE(make_file(folder_ / "in.exr", {spec_of(GetParam(), kColors)}, {samples}));
  for (const char* wanted : {"", "dwaa", "b44", "pxr24", "piz"}) {
    SCOPED_TRACE(wanted);
    const Written made = process(wanted);
    ASSERT_EQ(window_of(made.spec), made.picture.data_window);
    const int x = GetParam().data.x, y = GetParam().data.y;
    EXPECT_NEAR(made.at(x, y, 0), 0.5F * samples[0] + kLight, 0.1F);
    EXPECT_NEAR(made.at(made.spec.x, made.spec.y, 3), made.picture.color.pixels[3], 0.1F);
  }
}

TEST_P(KeepLayersWindows, OtherPartsStayAsTheyAre) {
  const Windows whole{"whole", GetParam().display, GetParam().display};
  auto beauty = spec_of(GetParam(), static_cast<int>(kNames.size())),
       extra = make_spec(whole.data.width, whole.data.height, {"extra.R", "extra.G", "extra.B"}, OIIO::TypeHalf);
  extra.x = extra.full_x = whole.data.x, extra.y = extra.full_y = whole.data.y;
  extra.full_width = whole.data.width, extra.full_height = whole.data.height;
  extra.attribute("compression", "dwaa");
  beauty.attribute("oiio:subimagename", "rgba");
  extra.attribute("oiio:subimagename", "extra");
  const auto samples = samples_of(GetParam(), static_cast<int>(kNames.size()));
  ASSERT_NO_FATAL_FAILURE(
      make_file(folder_ / "in.exr", {extra, beauty}, {marks(whole.data.width, whole.data.height, 3), samples}));
  for (const char* wanted : {"", "piz"}) ASSERT_NO_FATAL_FAILURE(expect_right(process(wanted, 1), samples, GetParam()));
  const Written other = process("", 0);
  EXPECT_EQ(window_of(other.spec), whole.data);
  EXPECT_EQ(other.spec.get_string_attribute("compression"), "dwaa");
}

INSTANTIATE_TEST_SUITE_P(All, KeepLayersWindows,
                         testing::Values(Windows{"whole", {0, 0, 40, 24}, {0, 0, 40, 24}},
                                         Windows{"inside", {7, 5, 20, 11}, {0, 0, 40, 24}},
                                         Windows{"one_pixel", {39, 23, 1, 1}, {0, 0, 40, 24}},
                                         Windows{"over_the_corner", {-6, -4, 30, 20}, {0, 0, 40, 24}},
                                         Windows{"over_the_end", {25, 15, 30, 20}, {0, 0, 40, 24}},
                                         Windows{"overscan", {-3, -2, 47, 29}, {0, 0, 40, 24}},
                                         Windows{"beside", {44, 2, 10, 9}, {0, 0, 40, 24}},
                                         Windows{"before", {-12, -30, 10, 9}, {0, 0, 40, 24}},
                                         Windows{"far_away", {4000, 4000, 10, 9}, {0, 0, 40, 24}},
                                         Windows{"display_elsewhere", {-20, -9, 17, 13}, {-31, -17, 40, 24}},
                                         Windows{"tall", {3, 250, 9, 300}, {0, 0, 15, 560}}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace afterglow
