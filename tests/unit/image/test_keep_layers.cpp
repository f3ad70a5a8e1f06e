// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <half.h>

#include <cstring>

#include "image/writer.h"
#include "make_files.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {
using testing::HasSubstr;

class KeepLayers : public testing::Test {
 protected:
  KeepLayers() { options_.keep_layers = true; }
  /// Halves the colour and writes it with all layers.
  void process(const std::filesystem::path& in, const std::filesystem::path& out, const std::string& layer = "") {
    ReadOptions reading;
    reading.layer = layer;
    Picture picture = read_or_fail(in, reading);
    for (std::size_t i = 0; i < picture.color.pixels.size(); ++i)
      if (i % 4 != 3) picture.color.pixels[i] *= 0.5f;
    const auto written = write_picture(picture, out, options_, messages_.diagnostics);
    ASSERT_TRUE(written) << written.error().text();
  }
  struct Part {
    OIIO::ImageSpec spec;
    std::vector<unsigned char> bytes;  ///< native
    std::vector<float> samples;
  };
  static std::vector<Part> parts_of(const std::filesystem::path& file) {
    const auto input = OIIO::ImageInput::open(file.string());
    EXPECT_TRUE(input) << OIIO::geterror();
    std::vector<Part> parts;
    for (int i = 0; input && input->seek_subimage(i, 0); ++i) {
      Part part{input->spec(), {}, {}};
      part.bytes.resize(part.spec.image_bytes(true));
      part.samples.resize(part.spec.image_pixels() * static_cast<std::size_t>(part.spec.nchannels));
      EXPECT_TRUE(input->read_image(i, 0, 0, part.spec.nchannels, OIIO::TypeUnknown, part.bytes.data()));
      EXPECT_TRUE(input->read_image(i, 0, 0, part.spec.nchannels, OIIO::TypeFloat, part.samples.data()));
      parts.push_back(std::move(part));
    }
    return parts;
  }
  TemporaryFolder folder_;
  WriteOptions options_;
  Messages messages_;
};

TEST_F(KeepLayers, BlenderFileWithMixedTypes) {
  const auto in = test_image("blender/native.exr"), out = folder_ / "o.exr";
  ASSERT_NO_FATAL_FAILURE(process(in, out));
  const auto before = parts_of(in), after = parts_of(out);
  ASSERT_EQ(after.size(), 1u);
  EXPECT_EQ(after[0].spec.channelnames, before[0].spec.channelnames);
  EXPECT_EQ(after[0].spec.channelformats, before[0].spec.channelformats);
  EXPECT_EQ(after[0].spec.get_string_attribute("BlenderMultiChannel"),
            before[0].spec.get_string_attribute("BlenderMultiChannel"));
  const std::size_t channels = 8;
  for (std::size_t i = 0; i < before[0].samples.size(); ++i) {
    const float was = before[0].samples[i], is = after[0].samples[i];
    if (i % channels < 3) {
      ASSERT_EQ(is, static_cast<float>(Imath::half(std::max(was, 0.0f) * 0.5f)));
    } else {
      ASSERT_EQ(std::memcmp(&was, &is, sizeof was), 0);
    }
  }
}

TEST_F(KeepLayers, ColoursBesideAChosenChannelAreNotOverwritten) {
  const auto in = folder_ / "in.exr", out = folder_ / "o.exr";
  OIIO::ImageSpec spec(4, 2, 4, OIIO::TypeFloat);
  const auto with = [&](std::vector<std::string> names) {
    spec.nchannels = static_cast<int>(names.size());
    spec.channelnames = std::move(names);
    spec.alpha_channel = spec.z_channel = -1;
    std::vector<float> samples;
    for (int i = 0; i < 8 * spec.nchannels; ++i) samples.push_back(0.25f + static_cast<float>(i % spec.nchannels));
    const auto file = OIIO::ImageOutput::create(in.string());
    ASSERT_TRUE(file && file->open(in.string(), spec) && file->write_image(OIIO::TypeFloat, samples.data()));
  };
  ASSERT_NO_FATAL_FAILURE(with({"B", "G", "R", "Z"}));
  ReadOptions reading;
  reading.layer = "Z";
  const auto written = write_picture(read_or_fail(in, reading), out, options_, messages_.diagnostics);
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().text(), HasSubstr("what is made of 'Z' would take the place of 'R'"));
  EXPECT_FALSE(std::filesystem::exists(out));

  // A layer that lacks a colour gets it.
  ASSERT_NO_FATAL_FAILURE(with({"G", "R", "id"}));
  ASSERT_NO_FATAL_FAILURE(process(in, out));
  const auto after = parts_of(out);
  ASSERT_EQ(after.size(), 1u);
  EXPECT_EQ(after[0].spec.channelnames, (std::vector<std::string>{"R", "G", "B", "id"}));
  EXPECT_EQ((std::vector<float>{after[0].samples.begin(), after[0].samples.begin() + 4}),
            (std::vector<float>{0.625f, 0.125f, 0, 2.25f}));
}

/// OpenImageIO writes parts that are all tiled or all scan lines.
class KeepParts : public KeepLayers, public testing::WithParamInterface<bool> {};

TEST_P(KeepParts, OthersAreCopiedAsTheyAre) {
  auto beauty = make_spec(33, 21, {"R", "G", "B", "A"}, OIIO::TypeHalf),
       depth = make_spec(33, 21, {"Z"}, OIIO::TypeFloat),
       extra = make_spec(33, 21, {"extra.R", "extra.G", "extra.B"}, OIIO::TypeHalf);
  beauty.attribute("oiio:subimagename", "rgba");
  beauty.attribute("compression", "piz");
  depth.attribute("oiio:subimagename", "depth");
  extra.attribute("oiio:subimagename", "extra");
  extra.attribute("compression", "dwaa");  // lossy: must not be done twice
  if (GetParam())
    for (OIIO::ImageSpec* spec : {&beauty, &depth, &extra}) spec->tile_width = spec->tile_height = 16;
  ASSERT_NO_FATAL_FAILURE(
      make_file(folder_ / "in.exr", {depth, beauty, extra}, {marks(33, 21, 1), marks(33, 21, 4), marks(33, 21, 3)}));
  ASSERT_NO_FATAL_FAILURE(process(folder_ / "in.exr", folder_ / "o.exr"));
  const auto before = parts_of(folder_ / "in.exr"), after = parts_of(folder_ / "o.exr");
  ASSERT_EQ(after.size(), 3u);
  for (const std::size_t i : {std::size_t{0}, std::size_t{2}}) {
    EXPECT_EQ(after[i].bytes, before[i].bytes) << i;
    EXPECT_EQ(after[i].spec.get_string_attribute("compression"), before[i].spec.get_string_attribute("compression"));
    EXPECT_EQ(after[i].spec.tile_width, before[i].spec.tile_width);
    EXPECT_EQ(after[i].spec.get_string_attribute("oiio:subimagename"),
              before[i].spec.get_string_attribute("oiio:subimagename"));
  }
  EXPECT_EQ(after[1].spec.get_string_attribute("compression"), "zip");
  EXPECT_EQ(after[1].spec.tile_width, 0);
  EXPECT_EQ(after[1].samples[4], before[1].samples[4] * 0.5f);
  EXPECT_EQ(after[1].samples[7], before[1].samples[7]);
}
INSTANTIATE_TEST_SUITE_P(All, KeepParts, testing::Bool(),
                         [](const auto& info) { return info.param ? "tiled" : "scan_lines"; });

TEST_F(KeepLayers, ChosenLayerIsTheOneReplaced) {
  const std::vector<std::string> names{"R", "G", "B", "glow.R", "glow.G", "glow.B"};
  ASSERT_NO_FATAL_FAILURE(
      make_file(folder_ / "in.exr", {make_spec(9, 300, names, OIIO::TypeHalf)}, {marks(9, 300, 6)}));
  ASSERT_NO_FATAL_FAILURE(process(folder_ / "in.exr", folder_ / "o.exr", "glow"));
  const auto after = parts_of(folder_ / "o.exr");
  EXPECT_EQ(after[0].spec.channelnames, names);
  for (int y = 0; y < 300; ++y)
    for (int x = 0; x < 9; ++x)
      for (int c = 0; c < 6; ++c)
        ASSERT_NEAR(after[0].samples[static_cast<std::size_t>((y * 9 + x) * 6 + c)], mark(x, y, c) * (c < 3 ? 1 : 0.5f),
                    3e-4);
}

/// What each method loses, and of what: OpenEXR packs colours, whole floats or half floats with loss.
struct Method {
  const char* name;
  std::vector<std::string> harmless, changed;  ///< layers
};

class KeepCompressed : public KeepLayers, public testing::WithParamInterface<Method> {
 protected:
  static inline const std::vector<std::string> kNames{
      "R", "G", "B", "A", "Z", "Ids00.R", "Ids00.G", "Ids00.B", "Ids00.A", "Matte.R", "Names.id", "Names.part"};
  static OIIO::ImageSpec spec_of(const std::vector<std::string>& layers) {
    OIIO::ImageSpec spec = make_spec(40, 70, {"R", "G", "B", "A"}, OIIO::TypeHalf);
    for (const std::string& name : kNames)
      if (std::ranges::find(layers, name.substr(0, name.find('.'))) != layers.end()) spec.channelnames.push_back(name);
    spec.nchannels = static_cast<int>(spec.channelnames.size());
    for (const std::string& name : spec.channelnames) {
      const bool half = name.size() == 1 && name != "Z", whole = name == "Names.part";
      spec.channelformats.push_back(half || name.starts_with("Matte") ? OIIO::TypeHalf
                                    : whole                           ? OIIO::TypeUInt32
                                                                      : OIIO::TypeFloat);
    }
    spec.format = OIIO::TypeFloat;
    return spec;
  }
  /// Bits that any loss shows in.
  static std::vector<float> ids(int channels) {
    std::vector<float> samples = marks(40, 70, channels);
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (i % static_cast<std::size_t>(channels) > 3) samples[i] += 1e-7F;
    return samples;
  }
  /// Writes a file with these layers. The compression that was taken.
  std::string kept(const std::vector<std::string>& layers) {
    const OIIO::ImageSpec spec = spec_of(layers);
    make_file(folder_ / "in.exr", {spec}, {ids(spec.nchannels)});
    options_.compression = GetParam().name;
    process(folder_ / "in.exr", folder_ / "o.exr");
    const auto before = parts_of(folder_ / "in.exr"), after = parts_of(folder_ / "o.exr");
    EXPECT_EQ(after[0].spec.channelnames, before[0].spec.channelnames);
    for (std::size_t i = 0; i < before[0].samples.size(); ++i)
      if (i % static_cast<std::size_t>(spec.nchannels) > 3 && before[0].samples[i] != after[0].samples[i]) {
        ADD_FAILURE() << spec.channelnames[i % static_cast<std::size_t>(spec.nchannels)] << " has changed";
        break;
      }
    return after[0].spec.get_string_attribute("compression");
  }
};

TEST_P(KeepCompressed, LayersLoseNothing) {
  EXPECT_TRUE(kept({}).starts_with(GetParam().name));
  EXPECT_TRUE(kept(GetParam().harmless).starts_with(GetParam().name));
  EXPECT_THAT(messages_.warnings, testing::IsEmpty());
  for (const std::string& layer : GetParam().changed) {
    EXPECT_EQ(kept({layer}), "zip");
    EXPECT_THAT(messages_.warnings.back(),
                HasSubstr("--compression " + std::string(GetParam().name) + " would change layers that are kept (" +
                          layer + "); zip is taken"));
  }
}

TEST_P(KeepCompressed, TheColourHasItInAPartOfItsOwn) {
  auto beauty = make_spec(40, 70, {"R", "G", "B", "A"}, OIIO::TypeHalf),
       names = make_spec(40, 70, {"Ids00.R", "Ids00.G", "Ids00.B", "Ids00.A"}, OIIO::TypeFloat);
  beauty.attribute("oiio:subimagename", "rgba");
  names.attribute("oiio:subimagename", "ids");
  make_file(folder_ / "in.exr", {beauty, names}, {marks(40, 70, 4), ids(4)});
  options_.compression = GetParam().name;
  process(folder_ / "in.exr", folder_ / "o.exr");
  const auto before = parts_of(folder_ / "in.exr"), after = parts_of(folder_ / "o.exr");
  EXPECT_EQ(after[0].spec.get_string_attribute("compression").substr(0, 4), std::string(GetParam().name).substr(0, 4));
  EXPECT_EQ(after[1].bytes, before[1].bytes);
  EXPECT_THAT(messages_.warnings, testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(All, KeepCompressed,
                         testing::Values(Method{"pxr24", {"Matte"}, {"Z", "Ids00", "Names"}},
                                         Method{"b44", {"Z", "Ids00", "Names"}, {"Matte"}},
                                         Method{"b44a", {"Z", "Ids00", "Names"}, {"Matte"}},
                                         Method{"dwaa", {"Z", "Names"}, {"Ids00", "Matte"}},
                                         Method{"dwab", {"Z", "Names"}, {"Ids00", "Matte"}}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_F(KeepLayers, TiledMipFileBecomesScanLines) {
  ASSERT_NO_FATAL_FAILURE(process(test_image("openexr/MultiResolution_ColorCodedLevels.exr"), folder_ / "o.exr"));
  EXPECT_EQ(parts_of(folder_ / "o.exr")[0].spec.tile_width, 0);
}

TEST_F(KeepLayers, GreyAndLuminanceChromaBecomeColour) {
  ASSERT_NO_FATAL_FAILURE(process(test_image("openexr/TestImages_GrayRampsHorizontal.exr"), folder_ / "grey.exr"));
  EXPECT_EQ(parts_of(folder_ / "grey.exr")[0].spec.channelnames, (std::vector<std::string>{"R", "G", "B"}));
  ASSERT_NO_FATAL_FAILURE(process(test_image("openexr/Chromaticities_Rec709_YC.exr"), folder_ / "yc.exr"));
  EXPECT_EQ(parts_of(folder_ / "yc.exr")[0].spec.channelnames, (std::vector<std::string>{"R", "G", "B"}));
}

TEST_F(KeepLayers, OntoItself) {
  std::filesystem::copy_file(test_image("blender/native.exr"), folder_ / "a.exr");
  ASSERT_NO_FATAL_FAILURE(process(folder_ / "a.exr", folder_ / "a.exr"));
  EXPECT_EQ(parts_of(folder_ / "a.exr")[0].spec.nchannels, 8);
}

TEST_F(KeepLayers, FileThatChangedMeanwhile) {
  std::filesystem::copy_file(test_image("blender/native.exr"), folder_ / "a.exr");
  const Picture picture = read_or_fail(folder_ / "a.exr");
  std::filesystem::copy_file(test_image("blender/flat.exr"), folder_ / "a.exr",
                             std::filesystem::copy_options::overwrite_existing);
  auto written = write_picture(picture, folder_ / "o.exr", options_, messages_.diagnostics);
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("changed"));
  std::filesystem::remove(folder_ / "a.exr");
  EXPECT_FALSE(write_picture(picture, folder_ / "o.exr", options_, messages_.diagnostics));
  EXPECT_EQ(folder_.count(), 0);
}

TEST_F(KeepLayers, InputsWithoutLayersAreWarnedAbout) {
  ASSERT_NO_FATAL_FAILURE(make_file(folder_ / "in.png", 3, 3, {"R", "G", "B"}, OIIO::TypeUInt8));
  ASSERT_NO_FATAL_FAILURE(process(folder_ / "in.png", folder_ / "o.exr"));
  EXPECT_EQ(messages_.warnings.size(), 1u);
}

}  // namespace
}  // namespace afterglow
