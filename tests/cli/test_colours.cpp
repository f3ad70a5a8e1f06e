// SPDX-License-Identifier: MIT
// What colours of files mean that say it in their own ways, and what is told of those that Rec.709 does not have.
#include <OpenImageIO/imageio.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>

#include "cli_test.h"
#include "image/icc_profile.h"

namespace afterglow::test {
namespace {

std::string big(std::uint32_t value) {
  std::string out;
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift);
  return out;
}
std::string little(std::uint32_t value) {
  std::string out = big(value);
  std::ranges::reverse(out);
  return out;
}

/// sRGB whose red and green have changed their places.
std::string turned_profile() {
  const std::vector<std::uint8_t> bytes = srgb_icc_profile();
  std::string profile(bytes.begin(), bytes.end());
  profile.replace(profile.find("rXYZ"), 4, "????");
  profile.replace(profile.find("gXYZ"), 4, "rXYZ");
  profile.replace(profile.find("????"), 4, "gXYZ");
  return profile;
}

/// 64×64, wholly red, 8 bits, P3 by its nclx; made by `ffmpeg -f lavfi -i color=red … -color_primaries smpte432`.
std::string red_avif() {
  constexpr std::string_view kHex =
      "00000020667479706176696600000000617669666d6966316d6961664d413141000000f96d657461000000000000002f68646c7200000000"
      "00000000706963740000000000000000000000005069637475726548616e646c6572000000000e7069746d0000000000010000001e696c6f"
      "63000000004400000100010000000100000121000000220000002869696e660000000000010000001a696e66650200000000010000617630"
      "31436f6c6f72000000006a697072700000004b6970636f0000001469737065000000000000004000000040000000107069786900000000"
      "030808080000000c617631438120000000000013636f6c726e636c78000c000d0005000000001769706d61000000000000000100010401"
      "0283040000002a6d6461740a0938157ffdb4303414403215128000004000000000ebc7d55865ce76d500173684";
  std::string out;
  for (std::size_t i = 0; i + 1 < kHex.size(); i += 2)
    out += static_cast<char>(std::stoi(std::string(kHex.substr(i, 2)), nullptr, 16));
  return out;
}

/// The same with a profile in place of the nclx.
std::string red_avif_with(const std::string& profile) {
  std::string file = red_avif();
  const std::size_t box = file.find("colr") - 4;
  const std::string colr = big(static_cast<std::uint32_t>(12 + profile.size())) + "colrprof" + profile;
  const auto more = static_cast<std::uint32_t>(colr.size() - 19);
  file.replace(box, 19, colr);
  for (const char* name : {"meta", "iprp", "ipco"}) {
    const std::size_t at = file.find(name) - 4;
    std::uint32_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) size = size << 8 | static_cast<std::uint8_t>(file[at + i]);
    file.replace(at, 4, big(size + more));
  }
  file.replace(file.find(big(0x121)), 4, big(0x121 + more));  // where the picture begins
  return file;
}

class Colours : public CliTest {
 protected:
  using Pixel = std::vector<float>;

  void SetUp() override {
    CliTest::SetUp();
    write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { name = \"nothing\" }\n");
  }
  void make(const std::string& name, OIIO::ImageSpec spec, const std::vector<float>& color) const {
    std::vector<float> pixels;
    for (int i = 0; i < spec.width * spec.height; ++i) pixels.insert(pixels.end(), color.begin(), color.end());
    const auto output = OIIO::ImageOutput::create(name);
    ASSERT_TRUE(output && output->open(text(name), spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeFloat, pixels.data()) && output->close());
  }
  /// The first pixel, and what was said.
  Pixel read_as_light(const std::string& name, std::string* said = nullptr) const {
    const Outcome outcome = run({"run", "look.lua", name, "-o", "light.exr", "--type", "float"});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    if (said) *said = outcome.err;
    Pixel all = pixels_of("light.exr");
    all.resize(3);
    return all;
  }
  static void expect_near(const Pixel& found, const Pixel& wanted, const std::string& what) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], wanted[c], 0.02 * std::max(1.0f, wanted[c])) << what;
  }
};

TEST_F(Colours, OutsideRec709AreTold) {
  OIIO::ImageSpec spec(64, 64, 3, OIIO::TypeFloat);
  const float acescg[8] = {0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f};
  spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), acescg);
  ASSERT_NO_FATAL_FAILURE(make("a.1.exr", spec, {1, 0, 0}));
  ASSERT_NO_FATAL_FAILURE(make("a.2.exr", spec, {1, 0, 0}));
  const Outcome outcome = run({"run", "look.lua", "a.#.exr", "-o", "b.#.exr"});
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_THAT(outcome.err,
              ContainsRegex("a\\.[12]\\.exr: 8192 samples are of colours outside Rec\\.709; they end at 0"));
  EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
  std::string said;
  ASSERT_NO_FATAL_FAILURE(make("in.exr", spec, {0.5f, 0.4f, 0.4f}));
  read_as_light("in.exr", &said);
  EXPECT_THAT(said, IsEmpty());
}

/// Into the space that they came from they go back as they were, codes below black too.
TEST_F(Colours, OutsideRec709AreKeptWhereAsked) {
  const auto there_and_back = [&](const std::string& name, const std::string& space, const std::string& gamut) {
    const Outcome outcome = run({"run", "look.lua", name, "-o", "back." + name, "--input-space", space,
                                 "--output-space", space, "--gamut", gamut});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_EQ(outcome.err.empty(), gamut == "keep") << outcome.err;
    Pixel all = pixels_of("back." + name);
    all.resize(3);
    return all;
  };
  for (const bool half : {true, false}) {
    const OIIO::ImageSpec spec(64, 64, 3, half ? OIIO::TypeHalf : OIIO::TypeFloat);
    ASSERT_NO_FATAL_FAILURE(make("a.exr", spec, {1, 0.0625f, 0.03125f}));
    const Pixel kept = there_and_back("a.exr", "acescg", "keep");
    EXPECT_NEAR(kept[0], 1, 1e-3);
    EXPECT_NEAR(kept[1], 0.0625, 1e-3);
    EXPECT_NEAR(kept[2], 0.03125, 1e-3);
    EXPECT_GT(there_and_back("a.exr", "acescg", "cut")[1], 0.1);
  }
  const OIIO::ImageSpec spec(64, 64, 3, OIIO::TypeUInt16);
  const Pixel codes{0.05f, 0.7f, 0.3f};
  ASSERT_NO_FATAL_FAILURE(make("a.tif", spec, codes));
  for (const char* space : {"logc3", "logc4", "slog3", "acescct"}) {
    const Pixel kept = there_and_back("a.tif", space, "keep");
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(kept[c], codes[c], 1.5 / 65535) << space << c;
    EXPECT_GT(there_and_back("a.tif", space, "cut")[0], 0.06) << space;
  }
}

TEST_F(Colours, ALookSaysThatTheyAreKept) {
  const OIIO::ImageSpec spec(64, 64, 3, OIIO::TypeFloat);
  ASSERT_NO_FATAL_FAILURE(make("a.exr", spec, {1, 0.0625f, 0.03125f}));
  write("look.lua", "return require(\"afterglow\").stack { input_space = \"acescg\", gamut = \"keep\" }\n");
  const auto green = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"run", "look.lua", "a.exr", "-o", "b.exr", "--output-space", "acescg"};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = run(all);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return pixels_of("b.exr")[1];
  };
  EXPECT_NEAR(green({}), 0.0625, 1e-3);
  EXPECT_GT(green({"--gamut", "cut"}), 0.1) << "the command line goes before it";
  write("look.lua", "return require(\"afterglow\").stack { input_space = \"acescg\" }\n");
  EXPECT_GT(green({}), 0.1);
  EXPECT_NEAR(green({"--gamut", "keep"}), 0.0625, 1e-3);
}

TEST_F(Colours, NegativeLightIsTold) {
  for (const bool half : {true, false}) {
    const OIIO::ImageSpec spec(64, 64, 3, half ? OIIO::TypeHalf : OIIO::TypeFloat);
    std::string said;
    ASSERT_NO_FATAL_FAILURE(make("a.exr", spec, {0.5f, -0.05f, 0.2f}));
    read_as_light("a.exr", &said);
    EXPECT_THAT(said, HasSubstr("a.exr: 4096 samples are below -0.01; light is not negative, they count as 0")) << half;
    ASSERT_NO_FATAL_FAILURE(make("noise.exr", spec, {0.5f, -0.009f, 0.2f}));
    read_as_light("noise.exr", &said);
    EXPECT_THAT(said, IsEmpty());
  }
}

TEST_F(Colours, ExrInOtherPrimaries) {
  // (0.5, 0.2, 0.1) in primaries AP1, by the published matrix of Rec.709 to ACEScg.
  const Pixel light{0.5f, 0.2f, 0.1f}, ap1{0.37924f, 0.21973f, 0.11919f};
  constexpr float kAcescg[8] = {0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f};
  const auto says = [&](const std::string& file) {
    const auto input = OIIO::ImageInput::open(text(file));
    std::vector<float> said(8);
    EXPECT_TRUE(input &&
                input->spec().getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), said.data()));
    return said;
  };
  const auto expect_acescg = [&](const std::string& file) {
    const auto said = says(file);
    for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(said[i], kAcescg[i], 1e-6) << file << " " << i;
  };
  ASSERT_NO_FATAL_FAILURE(make("plain.exr", {8, 8, 3, OIIO::TypeFloat}, light));
  for (const char* type : {"half", "float"}) {
    const Outcome outcome =
        run({"run", "look.lua", "plain.exr", "-o", "ap1.exr", "--output-space", "acescg", "--type", type});
    ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
    expect_acescg("ap1.exr");
    const auto stored = pixels_of("ap1.exr"), again = read_as_light("ap1.exr");
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(stored[c], ap1[c], 3e-4) << type;
      EXPECT_NEAR(again[c], light[c], 5e-4) << type;
    }
  }
  // Beside layers that stay, the colour has their primaries.
  OIIO::ImageSpec spec(8, 8, 6, OIIO::TypeFloat);
  spec.channelnames = {"R", "G", "B", "diffuse.R", "diffuse.G", "diffuse.B"};
  Pixel both = ap1;
  both.insert(both.end(), ap1.begin(), ap1.end());
  const auto expect_kept = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"run",      "look.lua",      "layers.exr", "-o",
                                   "kept.exr", "--keep-layers", "--type",     "float"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
    const auto found = pixels_of("kept.exr");
    for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(found[c], both[c], 1e-5) << c;
  };
  ASSERT_NO_FATAL_FAILURE(make("layers.exr", spec, both));
  expect_kept({"--input-space", "acescg"});
  spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), kAcescg);
  ASSERT_NO_FATAL_FAILURE(make("layers.exr", spec, both));
  expect_kept({});
  expect_acescg("kept.exr");
  expect_kept({"--layer", "diffuse"});
  const Outcome refused =
      run({"run", "look.lua", "layers.exr", "-o", "no.exr", "--keep-layers", "--output-space", "acescg"});
  EXPECT_EQ(refused.exit_code, kUsage);
  EXPECT_THAT(refused.err, HasSubstr("--keep-layers writes colours in the primaries of the layers beside them"));
}

/// The chunk of a lossless one, without those around it.
std::string pixels_of_webp(const std::string& file) {
  const std::size_t at = file.find("VP8L");
  std::size_t size = 0;
  for (std::size_t i = 0; i < 4; ++i) size |= std::size_t{static_cast<unsigned char>(file.at(at + 4 + i))} << 8 * i;
  return file.substr(at, 8 + size + size % 2);
}

TEST_F(Colours, ProfilesOfWebpAndAvif) {
  ASSERT_NO_FATAL_FAILURE(make("plain.exr", {64, 64, 3, OIIO::TypeHalf}, {1, 0, 0}));
  ASSERT_EQ(run({"run", "look.lua", "plain.exr", "-o", "plain.webp"}).exit_code, kDone);
  expect_near(read_as_light("plain.webp"), {1, 0, 0}, "plain");
  const std::string profile = turned_profile(), plain = pixels_of_webp(read("plain.webp"));
  const auto with = [&](const std::string& icc, std::uint32_t claimed) {
    std::string body = "WEBPVP8X" + little(10) + little(0x20) + std::string("\x3f\0\0\x3f\0\0", 6);
    body += "ICCP" + little(claimed) + icc + std::string(icc.size() % 2, '\0') + plain;
    return "RIFF" + little(static_cast<std::uint32_t>(body.size())) + body;
  };
  const auto size = static_cast<std::uint32_t>(profile.size());
  write("turned.webp", with(profile, size));
  expect_near(read_as_light("turned.webp"), {0, 1, 0}, "webp");
  write("turned.avif", red_avif_with(profile));
  expect_near(read_as_light("turned.avif"), {0, 1, 0}, "avif");
  std::string said;
  write("damaged.webp", with(profile.substr(0, 200), 200));
  expect_near(read_as_light("damaged.webp", &said), {1, 0, 0}, "damaged");
  EXPECT_THAT(said, HasSubstr("damaged.webp: has a damaged ICC profile; the profile is ignored"));
  write("huge.webp", with(profile, 0x7fffffff));
  const Outcome huge = run({"run", "look.lua", "huge.webp", "-o", "a.png"});
  EXPECT_EQ(huge.exit_code, kFiles);
  EXPECT_THAT(huge.err, HasSubstr("has more than 16 MiB of metadata in one piece"));
}

TEST_F(Colours, CodesOfAvif) {
  write("p3.avif", red_avif());
  expect_near(read_as_light("p3.avif"), {1.225f, 0, 0}, "P3");
  const auto coded = [](char primaries, char transfer) {
    std::string file = red_avif();
    const std::size_t at = file.find("nclx") + 4;
    file[at + 1] = primaries;
    file[at + 3] = transfer;
    return file;
  };
  write("srgb.avif", coded(1, 13));
  expect_near(read_as_light("srgb.avif"), {1, 0, 0}, "sRGB");
  write("pq.avif", coded(9, 16));
  expect_near(read_as_light("pq.avif"), {81.8f, 0, 0}, "PQ");
}

TEST_F(Colours, CodesOfPng) {
  ASSERT_NO_FATAL_FAILURE(make("plain.png", {8, 8, 3, OIIO::TypeUInt8}, {1, 0, 0}));
  ASSERT_NO_FATAL_FAILURE(make("half.png", {8, 8, 3, OIIO::TypeUInt8}, {0.5f, 0, 0}));
  const std::string plain = read("plain.png"), half = read("half.png");
  const auto chunk = [](const std::string& named) {
    const auto crc = crc32(0, reinterpret_cast<const Bytef*>(named.data()), static_cast<uInt>(named.size()));
    return big(static_cast<std::uint32_t>(named.size() - 4)) + named + big(static_cast<std::uint32_t>(crc));
  };
  const auto coded = [&](const std::string& four) {
    write("coded.png", plain.substr(0, 33) + chunk("cICP" + four) + plain.substr(33));
  };
  const auto with_gamma_1 = [&](const std::string& four) {
    write("coded.png", half.substr(0, 33) + chunk("cICP" + four) + chunk("gAMA" + big(100000)) + half.substr(33));
  };
  std::string said;
  coded(std::string("\x0c\x0d\0\1", 4));
  expect_near(read_as_light("coded.png"), {1.225f, 0, 0}, "P3");
  coded(std::string("\x09\x10\0\1", 4));
  expect_near(read_as_light("coded.png"), {81.8f, 0, 0}, "PQ");
  coded(std::string("\x09\x12\0\1", 4));
  expect_near(read_as_light("coded.png"), {6.27f, 0, 0}, "HLG");
  coded(std::string("\x01\x0d\0\0", 4));
  expect_near(read_as_light("coded.png", &said), {1, 0, 0}, "limited");
  EXPECT_THAT(said, HasSubstr("says that its samples have the range of video; they are read as of full range"));
  coded(std::string("\xc8\x0d\0\1", 4));
  expect_near(read_as_light("coded.png", &said), {1, 0, 0}, "unknown");
  EXPECT_THAT(said, HasSubstr("its colours (primaries 200, transfer 13 of H.273) are not known; they are ignored"));
  constexpr float kStored = 128 / 255.0f;
  with_gamma_1(std::string("\x02\x02\0\1", 4));
  expect_near(read_as_light("coded.png"), {kStored, 0, 0}, "nothing said: gAMA counts");
  with_gamma_1(std::string("\x0c\x02\0\1", 4));
  expect_near(read_as_light("coded.png"), {1.225f * kStored, 0, 0}, "P3, the curve of gAMA");
  with_gamma_1(std::string("\x02\x0d\0\1", 4));
  expect_near(read_as_light("coded.png"), {0.2158f, 0, 0}, "the curve alone");
}

}  // namespace
}  // namespace afterglow::test
