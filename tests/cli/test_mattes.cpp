// SPDX-License-Identifier: MIT
// Mattes that come as channels, files and ids: which channel is taken, and what is told where it is not there.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imageio.h>

#include <bit>
#include <cstdio>
#include <functional>

#include "cli_test.h"
#include "image/cryptomatte.h"

namespace afterglow::test {
namespace {

constexpr int kWidth = 8, kHeight = 4;
constexpr float kLight = 0.5F;

class Mattes : public CliTest {
 protected:
  static float matte(int x) { return static_cast<float>(x) / kWidth; }
  using Attributes = std::vector<std::pair<std::string, std::string>>;
  /// `value(channel, x)` in every row.
  template <class Value>
  void make(const std::string& name, const std::vector<std::string>& channels, const Value& value,
            const Attributes& attributes = {}) const {
    OIIO::ImageSpec spec(kWidth, kHeight, static_cast<int>(channels.size()), OIIO::TypeFloat);
    spec.channelnames = channels;
    for (const auto& [key, text] : attributes) spec.attribute(key, text);
    std::vector<float> samples;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        for (const std::string& channel : channels) samples.push_back(value(channel, x));
    auto out = OIIO::ImageOutput::create(text(name));
    ASSERT_TRUE(out && out->open(text(name), spec) && out->write_image(OIIO::TypeFloat, samples.data()) &&
                out->close());
  }
  /// Twice the light where the mask is 1.
  Outcome run_mask(const std::string& mask, const std::string& picture = "a.exr") const {
    write("look.lua",
          "local fx = require \"afterglow\"\nreturn fx.stack { fx.exposure { ev = 1, mask = " + mask + " } }\n");
    const Outcome outcome = run({"run", "look.lua", picture, "-o", "o.exr", "--type", "float"});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return outcome;
  }
  /// The mask of a column, by what was made of the light.
  std::vector<float> made() const {
    const auto pixels = pixels_of("o.exr");
    std::vector<float> out;
    for (std::size_t x = 0; x < kWidth && pixels.size() >= 3 * kWidth; ++x) out.push_back(pixels[3 * x] / kLight - 1);
    return out;
  }
  void expect_mask(const std::function<float(int)>& wanted, const std::string& what) const {
    const auto is = made();
    ASSERT_EQ(is.size(), static_cast<std::size_t>(kWidth));
    for (int x = 0; x < kWidth; ++x) ASSERT_NEAR(is[static_cast<std::size_t>(x)], wanted(x), 1e-5) << what << ", " << x;
  }
};

TEST_F(Mattes, ALonelyAlphaIsAlpha) {
  const auto value = [](const std::string& channel, int x) {
    if (channel.size() == 1 && channel != "A") return kLight;
    return channel == "wide.R" ? 0.25F : matte(x);
  };
  make("a.exr", {"R", "G", "B", "matte.A", "wide.R", "wide.A"}, value);
  make("roto.exr", {"A"}, value);
  make("plain.exr", {"R", "G", "B"}, value);
  for (const char* channel : {"a", "r", "luma"})
    for (const char* mask : {"file { file = \"roto.exr\"", "layer { layer = \"matte\""}) {
      const std::string text = std::string("fx.mask.") + mask + ", channel = \"" + channel + "\" }";
      EXPECT_THAT(run_mask(text).err, Not(HasSubstr("warning"))) << text;
      expect_mask(matte, text);
    }
  run_mask("fx.mask.layer { layer = \"wide\", channel = \"a\" }");
  expect_mask(matte, "beside one other");
  run_mask("fx.mask.layer { layer = \"wide\" }");
  expect_mask([](int) { return 0.25F; }, "the other");
  EXPECT_THAT(run_mask("fx.mask.file { file = \"plain.exr\", channel = \"a\" }").err,
              HasSubstr("plain.exr has no alpha; it counts as 1 everywhere"));
  EXPECT_THAT(run_mask("fx.mask.file { file = \"plain.exr\" }").err, Not(HasSubstr("warning")));
}

/// Renderers write them into files of their own.
TEST_F(Mattes, OfAnotherFile) {
  const auto light = [](const std::string&, int) { return kLight; };
  make("a.1.exr", {"R", "G", "B"}, light);
  make("a.2.exr", {"R", "G", "B"}, light);
  const Attributes attributes{{"cryptomatte/abc1234/name", "CryptoObject"},
                              {"cryptomatte/abc1234/hash", "MurmurHash3_32"},
                              {"cryptomatte/abc1234/conversion", "uint32_to_float32"},
                              {"cryptomatte/abc1234/manif_file", "names.json"}};
  const auto value = [](const std::string& channel, int x) {
    if (channel == "matte.V" || channel.ends_with("00.G")) return matte(x);
    return channel.ends_with("00.R") ? std::bit_cast<float>(cryptomatte_id("Lamp")) : 0.0F;
  };
  const std::vector<std::string> channels{"matte.V", "CryptoObject00.R", "CryptoObject00.G", "CryptoObject00.B",
                                          "CryptoObject00.A"};
  for (const char* name : {"m/m.1.exr", "m/m.2.exr"}) {
    fs::create_directories(path("m"));
    make(name, channels, value, attributes);
  }
  char digits[9];
  std::snprintf(digits, sizeof digits, "%08x", cryptomatte_id("Lamp"));
  write("m/names.json", std::string("{\"Lampe\":\"") + digits + "\"}");
  for (const char* mask : {"layer { layer = \"matte\"", "cryptomatte { names = \"Lampe\""}) {
    write("look.lua",
          std::string("local fx = require \"afterglow\"\nreturn fx.stack { fx.exposure { ev = 1, mask = fx.mask.") +
              mask + " } } }\n");
    const Outcome outcome =
        run({"run", "look.lua", "a.#.exr", "-o", "o.#.exr", "--type", "float", "--mattes", "m/m.#.exr"});
    ASSERT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_THAT(outcome.err, Not(HasSubstr("warning"))) << mask;
    fs::copy_file(path("o.2.exr"), path("o.exr"), fs::copy_options::overwrite_existing);
    expect_mask(matte, mask);
  }
  // A frame whose mattes are missing fails alone.
  fs::remove(path("m/m.1.exr"));
  const Outcome one = run({"run", "look.lua", "a.#.exr", "-o", "p.#.exr", "--mattes", "m/m.#.exr"});
  EXPECT_EQ(one.exit_code, kFiles);
  EXPECT_THAT(one.err, HasSubstr("m/m.1.exr: error: "));
  EXPECT_TRUE(fs::exists(path("p.2.exr")));
  EXPECT_THAT(run({"run", "look.lua", "a.2.exr", "-o", "q.exr", "--mattes", "nowhere.exr"}).err,
              HasSubstr("nowhere.exr"));
}

class CryptomatteManifests : public Mattes {
 protected:
  /// An object called Lamp covers its part of each pixel.
  void make_picture(const std::string& name, const Attributes& more = {}) const {
    Attributes attributes{{"cryptomatte/abc1234/name", "CryptoObject"},
                          {"cryptomatte/abc1234/hash", "MurmurHash3_32"},
                          {"cryptomatte/abc1234/conversion", "uint32_to_float32"}};
    attributes.insert(attributes.end(), more.begin(), more.end());
    make(
        name, {"R", "G", "B", "CryptoObject00.R", "CryptoObject00.G", "CryptoObject00.B", "CryptoObject00.A"},
        [](const std::string& channel, int x) {
          if (channel.size() == 1) return kLight;
          if (channel.ends_with("R")) return std::bit_cast<float>(cryptomatte_id("Lamp"));
          return channel.ends_with("G") ? matte(x) : 0.0F;
        },
        attributes);
  }
  std::string err(const std::string& name, const std::string& picture = "a.exr") const {
    return run_mask("fx.mask.cryptomatte { names = \"" + name + "\" }", picture).err;
  }
  static std::string manifest() {
    char digits[9];
    std::snprintf(digits, sizeof digits, "%08x", cryptomatte_id("Lamp"));
    return std::string("{\"Lampe\":\"") + digits + "\"}";
  }
};

TEST_F(CryptomatteManifests, MayLieBesideThePicture) {
  write("shot/names/man.json", manifest());
  write("man.json", manifest());
  make_picture("shot/a.exr", {{"cryptomatte/abc1234/manif_file", "names/man.json"}});
  EXPECT_THAT(err("Lampe", "shot/a.exr"), Not(HasSubstr("warning")));
  expect_mask(matte, "a name of the manifest");
  EXPECT_THAT(err("Lampp", "shot/a.exr"),
              HasSubstr("the cryptomatte 'CryptoObject' has no 'Lampp'; did you mean 'Lampe'?"));
  make_picture("shot/b.exr", {{"cryptomatte/abc1234/manif_file", "../man.json"}});
  EXPECT_THAT(err("Lamp", "shot/b.exr"), HasSubstr("the manifest '../man.json' of the cryptomatte 'CryptoObject' lies "
                                                   "outside of its folder; ids are made of the names themselves"));
  expect_mask(matte, "by its hash");
  make_picture("shot/c.exr", {{"cryptomatte/abc1234/manif_file", "gone.json"}});
  EXPECT_THAT(err("Lamp", "shot/c.exr"),
              HasSubstr("the manifest 'gone.json' of the cryptomatte 'CryptoObject' is not there"));
  write("shot/names/man.json", "rubbish");
  write("look.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.exposure { ev = 1, mask = fx.mask.cryptomatte "
        "{ names = \"Lamp\" } } }\n");
  EXPECT_THAT(run({"run", "look.lua", "shot/a.exr", "-o", "o.exr"}).err, HasSubstr("'CryptoObject' is no JSON object"));
}

TEST_F(CryptomatteManifests, AreAmongWhatResumeLooksAt) {
  fs::create_directories(path("shot"));
  make_picture("shot/a.exr", {{"cryptomatte/abc1234/manif_file", "man.json"}});
  write("look.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.exposure { ev = 1, mask = fx.mask.cryptomatte "
        "{ names = \"Lampe\" } } }\n");
  const auto run_again = [&] {
    const Outcome outcome =
        run({"run", "look.lua", "shot/a.exr", "-o", "o.exr", "--type", "float", "--resume", "--verbose"});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return outcome.err.find("up to date") != std::string::npos;
  };
  EXPECT_FALSE(run_again()) << "without a manifest";
  EXPECT_TRUE(run_again());
  write("shot/man.json", manifest());
  EXPECT_FALSE(run_again()) << "it has come";
  expect_mask(matte, "with a manifest");
  EXPECT_TRUE(run_again());
  write("shot/man.json", "{\"Lampe\":\"00000001\"}");
  EXPECT_FALSE(run_again()) << "it has changed";
}

TEST_F(CryptomatteManifests, WithoutOneANameThatNoPixelHasIsToldOnce) {
  for (const char* name : {"a.0001.exr", "a.0002.exr"}) make_picture(name);
  EXPECT_THAT(err("Lamp", "a.0001.exr"), Not(HasSubstr("warning")));
  expect_mask(matte, "by its hash");
  write("look.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.exposure { ev = 1, mask = fx.mask.cryptomatte "
        "{ names = \"Lampp, Lamp\" } } }\n");
  const Outcome outcome = run({"run", "look.lua", "a.####.exr", "-o", "o.####.exr"});
  const std::string told =
      "the cryptomatte 'CryptoObject' has no manifest, and no pixel has the id of the name 'Lampp': "
      "it selects nothing";
  const auto at = outcome.err.find(told);
  ASSERT_NE(at, std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("cryptomatte", at + told.size()), std::string::npos) << outcome.err;
}

// A picture that was painted as a mask: half is half, not the light that the code for half stands for.
TEST_F(CliTest, PicturesThatAreNumbers) {
  make_exr("a.exr", 8, 8);
  OIIO::ImageSpec spec(1, 1, 4, OIIO::TypeUInt8);
  spec.attribute("oiio:UnassociatedAlpha", 1);  // the numbers go into the file as they are
  OIIO::ImageBuf grey(spec);
  const float half = 128.0f / 255, numbers[] = {half, half, half, 51.0f / 255};
  grey.setpixel(0, 0, numbers);
  ASSERT_TRUE(grey.write(text("grey.png")));
  const auto brighter = [&](const std::string& settings) {
    write("look.lua",
          "local fx = require \"afterglow\"\nreturn fx.stack { fx.exposure { ev = 1, mask = fx.mask.file { "
          "file = \"grey.png\", " +
              settings + " } } }");
    const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "b.exr", "--type", "float"});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    return pixels_of("b.exr")[0] / pixels_of("a.exr")[0] - 1;
  };
  EXPECT_NEAR(brighter("channel = \"r\", raw = true"), 128.0 / 255, 1e-5);
  EXPECT_NEAR(brighter("channel = \"a\", raw = true"), 51.0 / 255, 1e-5);
  EXPECT_NEAR(brighter("channel = \"r\""), 0.2158605 * 51 / 255, 1e-5) << "light, times alpha";
}

/// Which layer a mask asks for may depend on the frame.
TEST_F(Mattes, LayersThatFramesAskFor) {
  const auto value = [](const std::string& channel, int x) {
    return channel.size() == 1 ? kLight : channel.starts_with("ma.") ? 0.0F : matte(x);
  };
  for (int frame = 1; frame <= 4; ++frame)
    make("s." + std::to_string(frame) + ".exr", {"R", "G", "B", "ma.R", "ma.G", "ma.B", "mb.R", "mb.G", "mb.B"}, value);
  write("look.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.exposure { ev = 1, mask = fx.mask.layer { channel = "
        "\"r\", layer = function(t) return t.frame < 3 and \"ma\" or \"mb\" end } } }\n");
  for (const std::string frames : {"1-4", "4"}) {
    const Outcome outcome = run({"run", "look.lua", "s.#.exr", "-o", "t.#.exr", "--frames", frames, "--type", "float"});
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_THAT(outcome.err, Not(HasSubstr("warning")));
    fs::rename(path("t.4.exr"), path("o.exr"));
    expect_mask(matte, "frame 4 of " + frames);
  }
  fs::rename(path("t.2.exr"), path("o.exr"));
  expect_mask([](int) { return 0.0F; }, "frame 2");
  const Outcome played = run({"play", "look.lua", "s.#.exr", "--headless", "--fast", "--screenshot", "o.exr"});
  EXPECT_EQ(played.exit_code, kDone) << played.err;
  EXPECT_THAT(played.err, Not(HasSubstr("warning")));
  expect_mask(matte, "played");
}

TEST_F(Mattes, AnEffectThatAsksForAnotherLayerEachTimeEnds) {
  make("a.exr", {"R", "G", "B"}, [](const std::string&, int) { return kLight; });
  write("effects/greedy.lua",
        "local fx = require \"afterglow\"\nlocal n = 0\nreturn fx.effect { name = \"greedy\", settings = { a = "
        "fx.float { "
        "default = 0 } },\n  needs = function(s) n = n + 1 return { \"layer:x\" .. n } end,\n"
        "  build = function(g, s, source) return source end }\n");
  write("look.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.greedy { a = function(t) return t.frame end } }\n");
  const Outcome outcome = run({"run", "look.lua", "a.exr", "-o", "o.exr"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("effect 'greedy' is skipped: no layer:x"));
}

}  // namespace
}  // namespace afterglow::test
