// SPDX-License-Identifier: MIT
// What was made of tables, pictures and configurations serves the next look: counted, not timed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>

#include "core/file_record.h"
#include "scene.h"
#include "script/asset_store.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;
using test::Scene;

class AssetStores : public testing::Test {
 protected:
  void SetUp() override {
    scene.effect("tint", R"(
      settings = { table = fx.file { default = "a.cube", extensions = { "cube" }, doc = "The table." },
                   amount = fx.float { default = 1, min = 0, max = 9, doc = "Of it." } },
      build = function(g, s, source)
        return g:pass { shader = "tint/apply", source = source, amount = s.amount,
                        numbers = g:lookup { file = s.table }.table }
      end,)");
    scene.write("shaders/tint/apply.glsl",
                "uniform sampler2D numbers;\nuniform float amount;\n"
                "vec4 apply(vec4 color) { return color + amount * fetch(numbers, ivec2(0)); }\n");
    scene.write("a.cube", table("0.25"));
    scene.stack("fx.tint {}");
    scene.options.assets = store;
  }
  static std::string table(const std::string& first) { return "LUT_1D_SIZE 2\n" + first + " 0 0\n1 1 1\n"; }
  /// A new look, as after each change of a setting: red of the table's first colour; or the error.
  std::string red() {
    auto preset = scene.load();
    if (!preset) return preset.error().text();
    auto graph = scene.build(*preset);
    if (!graph) return graph.error().text();
    for (const auto& image : graph->images)
      if (image.data) return std::to_string(image.data->pixels[0]).substr(0, 4);
    return "none";
  }
  std::shared_ptr<AssetStore> store = std::make_shared<AssetStore>();
  Scene scene;
};

TEST_F(AssetStores, ATableIsTakenApartOnceForManyLooks) {
  for (const char* amount : {"1", "2", "3"}) {
    scene.stack(std::string("fx.tint { amount = ") + amount + " }");
    EXPECT_EQ(red(), "0.25");
  }
  EXPECT_EQ(store->made(), 1u);
  scene.write("a.cube", table("0.50"));
  EXPECT_EQ(red(), "0.50") << "it is known by its content";
  scene.write("a.cube", table("0.25"));
  EXPECT_EQ(red(), "0.25");
  EXPECT_EQ(store->made(), 2u) << "one goes back to the look before";
}

TEST_F(AssetStores, OnlyWhatTheLastThreeLooksUsedStays) {
  for (const char* first : {"0.10", "0.20", "0.30", "0.40"}) {
    scene.write("a.cube", table(first));
    EXPECT_EQ(red(), first);
    EXPECT_LE(store->kept(), 3u);
  }
  scene.write("a.cube", table("0.10"));
  EXPECT_EQ(red(), "0.10");
  EXPECT_EQ(store->made(), 5u);
}

TEST_F(AssetStores, WhatWasReadIsNotReadAgainWhereRecordsAreKept) {
  constexpr std::size_t kBeyondWhatIsKept = 65u << 20;
  scene.options.record = FileRecord::keeping();
  for (const bool large : {false, true}) {
    const std::string name = large ? "large.cube" : "small.cube";
    scene.write(name, (large ? std::string(kBeyondWhatIsKept, '#') + "\n" : "") + table("0.25"));
    scene.stack("fx.tint { table = \"" + name + "\" }");
    scene.options.text = "local fx = require \"afterglow\"\nreturn fx.stack { fx.tint { table = \"" + name + "\" } }";
    EXPECT_EQ(red(), "0.25") << name;
    fs::remove(scene.folder() / name);
    EXPECT_EQ(red(), "0.25") << name;
    EXPECT_EQ(store->made(), large ? 2u : 1u);
  }
}

TEST_F(AssetStores, ConfigurationsAreKnownByAllThatDecides) {
  const auto configure = [&](const char* slope) {
    scene.write("studio.ocio",
                std::string("ocio_profile_version: 2\nsearch_path: \".:$AFTERGLOW_TEST_SHOT\"\nroles: {default: "
                            "lin_rec709, scene_linear: "
                            "lin_rec709}\nfile_rules: [!<Rule> {name: Default, colorspace: lin_rec709}]\n"
                            "displays: {Monitor: [!<View> {name: Film, colorspace: film}]}\n"
                            "colorspaces:\n  - !<ColorSpace> {name: lin_rec709}\n  - !<ColorSpace>\n    name: film\n"
                            "    from_scene_reference: !<GroupTransform> {children: [!<CDLTransform> {slope: [") +
                    slope + ", 1, 1]}, !<FileTransform> {src: curve.spi1d}]}\n");
  };
  const auto curve = [&](const char* last) {
    scene.write("curve.spi1d", std::string("Version 1\nFrom 0 1\nLength 2\nComponents 1\n{\n0\n") + last + "\n}\n");
  };
  const auto made = [&] {
    EXPECT_EQ(scene.build_error(), "");
    return store->made();
  };
  configure("1.1");
  curve("1");
  scene.stack("fx.ocio_display { config = \"studio.ocio\" }");
  EXPECT_EQ(made(), 1u);
  EXPECT_EQ(made(), 1u);
  configure("1.2");
  EXPECT_EQ(made(), 2u);
  curve("0.5");
  EXPECT_EQ(made(), 3u);
  setenv("AFTERGLOW_TEST_SHOT", "12", 1);
  EXPECT_EQ(made(), 4u) << "configurations read the environment";
  setenv("AFTERGLOW_TEST_OTHER", "12", 1);  // not this one
  EXPECT_EQ(made(), 4u);
  unsetenv("AFTERGLOW_TEST_SHOT");
  unsetenv("AFTERGLOW_TEST_OTHER");
}

/// A frame may hold 512 MiB; what others held goes when it is in the way, from the state and from the store.
TEST_F(AssetStores, PicturesByFrameMakeRoomForEachOther) {
  for (int i = 0; i < 5; ++i) {
    std::string values(std::size_t{4096} * 2048, '\x80');  // 128 MiB as floats, RGBA
    values[0] = static_cast<char>('0' + i);
    scene.write("p" + std::to_string(i) + ".pgm", "P5 4096 2048 255\n" + values);
  }
  scene.effect("shown", R"(
      settings = { file = fx.file { extensions = { "pgm" }, doc = "Of the frame." },
                   more = fx.int { default = 1, min = 1, max = 9, doc = "How many." } },
      build = function(g, s, source)
        for i = 1, s.more do
          local file = i == 1 and s.file or "p" .. i - 1 .. ".pgm"
          source = g:pass { shader = "shown/apply", source = source, picture = g:image { file = file } }
        end
        return source
      end,)");
  scene.write("shaders/shown/apply.glsl",
              "uniform sampler2D picture;\nvec4 apply(vec4 color) { return color + fetch(picture, ivec2(0)); }\n");
  scene.stack("fx.shown { file = function(t) return 'p' .. math.floor(t.frame) .. '.pgm' end }");
  auto preset = scene.load();
  ASSERT_TRUE(preset) << preset.error().text();
  std::optional<Graph> held;  // as a frame holds it that is still being drawn
  for (const int frame : {0, 1, 2, 3, 4, 0}) {
    scene.context.frame = frame;
    auto graph = scene.build(*preset);
    ASSERT_TRUE(graph) << "frame " << frame << ": " << graph.error().text();
    held = std::move(*graph);
    EXPECT_LE(store->kept(), 4u) << "frame " << frame;
  }
  EXPECT_EQ(store->made(), 6u) << "p0 had made room for others, and was read again";
  scene.context.frame = 4;
  ASSERT_TRUE(scene.build(*preset));
  EXPECT_EQ(store->made(), 6u) << "what nothing is in the way of stays";

  scene.stack("fx.shown { file = 'p0.pgm', more = 5 }");
  EXPECT_THAT(scene.build_error(),
              testing::HasSubstr("'p4.pgm' and what the look reads besides take more than 512 MiB"));
}

}  // namespace
}  // namespace afterglow
