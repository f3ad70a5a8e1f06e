// SPDX-License-Identifier: MIT
// The list of presets, and one frame through many of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>

#include "core/diagnostics.h"
#include "gpu/device.h"
#include "window/preset_list.h"
#include "window/thumbnails.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

TEST(PresetList, TheStoryIsTheFirstSentenceOfTheComment) {
  EXPECT_EQ(story_of("-- SPDX-License-Identifier: MIT\n-- A night in the rain. More of it.\nreturn 1\n"),
            "A night in the rain.");
  EXPECT_EQ(story_of("-- Two\n-- lines, and no end\n\n-- another\n"), "Two lines, and no end");
  EXPECT_EQ(story_of("local fx = 1 -- no\n"), "");
  EXPECT_EQ(story_of(""), "");
}

TEST(PresetList, ASearchFindsWordsAndPutsNamesFirst) {
  const std::vector<ListedPreset> all{{"day", "a", "Rain at noon."}, {"night", "b", "Neon."}, {"rain_city", "c", ""}};
  const auto names = [&](const std::string& search) {
    std::string out;
    for (const ListedPreset* one : found_presets(all, search)) out += one->name + " ";
    return out;
  };
  EXPECT_EQ(names(""), "day night rain_city ");
  EXPECT_EQ(names("Rain"), "rain_city day ");
  EXPECT_EQ(names("noon rain"), "day ");
  EXPECT_EQ(names("snow"), "");
}

class PresetFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("afterglow_presets" + std::to_string(getpid()));
    fs::create_directories(folder_);
    write("red", "fx.color_adjustments { color_filter = { 1, 0, 0 } }");
    write("plain", "");
    std::ofstream(folder_ / "wrong.lua") << "return 1 +\n";
  }
  void TearDown() override {
    std::error_code none;
    fs::remove_all(folder_, none);
  }
  void write(const std::string& name, const std::string& entry) {
    std::ofstream(folder_ / (name + ".lua"))
        << "-- The " << name << " one. Not this.\nlocal fx = require \"afterglow\"\n"
        << "return fx.stack { name = \"" << name << "\", " << entry << " }\n";
  }
  fs::path folder_;
};

TEST_F(PresetFolder, IsListedWithTheInstallations) {
  const auto all = list_presets(folder_ / "red.lua", {});
  const auto at = [&](const std::string& name) { return std::ranges::find(all, name, &ListedPreset::name); };
  ASSERT_NE(at("red"), all.end());
  EXPECT_EQ(at("red")->file, folder_ / "red.lua");
  EXPECT_EQ(at("red")->story, "The red one.");
  EXPECT_NE(at("wrong"), all.end()) << "a list tells of files that are wrong too";
  EXPECT_NE(at("neon_night"), all.end());
}

/// A picture of 640×400, half as bright as white.
ThumbnailFrame gray_frame(float level = 0.5f) {
  auto picture = std::make_shared<Picture>();
  picture->color = Image(640, 400, 4);
  for (std::size_t i = 0; i < picture->color.pixels.size(); ++i) picture->color.pixels[i] = i % 4 == 3 ? 1 : level;
  picture->data_window = picture->display_window = {0, 0, 640, 400};
  return {picture, {}, {}};
}

class ThumbnailsOfPresets : public PresetFolder {
 protected:
  std::shared_ptr<const Thumbnail> wait_for(Thumbnails& of, const std::string& name) {
    return wait_for(of, ThumbnailOf{file(name)});
  }
  std::shared_ptr<const Thumbnail> wait_for(Thumbnails& of, const ThumbnailOf& wanted) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (std::chrono::steady_clock::now() < end) {
      if (auto found = of.find(wanted)) return found;
      std::this_thread::yield();
    }
    return nullptr;
  }
  fs::path file(const std::string& name) const { return folder_ / (name + ".lua"); }
  static std::uint32_t middle(const Thumbnail& of) {
    return of.pixels.at(Thumbnail::kHeight / 2 * Thumbnail::kWidth + Thumbnail::kWidth / 2);
  }
};

TEST_F(ThumbnailsOfPresets, AreOfTheFrameAndTellErrors) {
  std::atomic<int> made = 0;
  Thumbnails thumbnails({.device = "auto", .validate = true}, {}, [&] { ++made; });
  thumbnails.want({file("red"), file("wrong"), file("plain")});
  EXPECT_EQ(thumbnails.find(file("red")), nullptr) << "there is no frame";
  thumbnails.set_frame(gray_frame());
  const auto red = wait_for(thumbnails, "red"), wrong = wait_for(thumbnails, "wrong"),
             plain = wait_for(thumbnails, "plain");
  ASSERT_TRUE(red && wrong && plain);
  ASSERT_FALSE(red->error) << red->error->text();
  EXPECT_EQ(middle(*red), 0xff0000bcu);
  EXPECT_EQ(red->pixels.front(), 0u) << "beside a picture of another form it is clear";
  ASSERT_TRUE(wrong->error);
  EXPECT_NE(wrong->error->text().find("wrong.lua:"), std::string::npos) << wrong->error->text();
  ASSERT_FALSE(plain->error) << plain->error->text();
  EXPECT_EQ(middle(*plain), 0xffbcbcbcu) << "a look that does nothing";
  EXPECT_FALSE(thumbnails.busy());
  EXPECT_EQ(made, 3);
}

/// What the panel has changed counts, and the effect is added to that; one that has nothing to do says why.
TEST_F(ThumbnailsOfPresets, OfAnEffectMore) {
  ChangedLook look;
  look.text = "local fx = require \"afterglow\"\nreturn fx.stack { fx.color_adjustments {} }\n";
  look.overrides = {{"color_adjustments", "color_filter", "{0, 1, 0}"}};
  const auto changed = std::make_shared<const ChangedLook>(look);
  Thumbnails thumbnails({.device = "auto", .validate = true}, {}, [] {});
  thumbnails.set_frame(gray_frame());
  const ThumbnailOf plain{file("red"), changed, ""}, darker{file("red"), changed, "vignette"},
      fog{file("red"), changed, "depth_fog"};
  thumbnails.want({plain, darker, fog});
  const auto as_it_is = wait_for(thumbnails, plain), with = wait_for(thumbnails, darker),
             nothing = wait_for(thumbnails, fog);
  ASSERT_TRUE(as_it_is && with && nothing);
  ASSERT_FALSE(as_it_is->error) << as_it_is->error->text();
  ASSERT_FALSE(with->error) << with->error->text();
  EXPECT_EQ(middle(*as_it_is) & 0xff, 0u) << "no red: what the panel has changed counts";
  EXPECT_GT(middle(*as_it_is) >> 8 & 0xff, 100u);
  EXPECT_NE(with->pixels, as_it_is->pixels) << "darker at its edges";
  EXPECT_EQ(middle(*with) & 0xff, 0u);
  EXPECT_EQ(with->note, "");
  EXPECT_TRUE(nothing->error || !nothing->note.empty()) << "there is no depth";
}

/// The look that is played asked for no depth; those of the list see it all the same.
TEST_F(ThumbnailsOfPresets, FramesHaveWhatOnlyTheListedLooksAskFor) {
  const auto fog = std::make_shared<const ChangedLook>(
      ChangedLook{"local fx = require \"afterglow\"\nreturn fx.stack { fx.depth_fog { density = 9, ambient = 0, "
                  "max_opacity = 1, color = { 0, 1, 0 "
                  "}, required = true } }\n",
                  {},
                  {}});
  ThumbnailFrame frame = gray_frame();
  frame.read = [plain = frame.picture]() -> Result<Picture> {
    Picture with = *plain;
    Image& depth = with.auxiliary["depth"] = Image(640, 400, 1);
    std::ranges::fill(depth.pixels, 100.0f);
    return with;
  };
  const ThumbnailOf wanted{file("red"), fog, ""};
  Thumbnails thumbnails({.device = "auto", .validate = true}, {}, [] {});
  thumbnails.set_frame(frame);
  thumbnails.want({wanted});
  const auto made = wait_for(thumbnails, wanted);
  ASSERT_TRUE(made);
  ASSERT_FALSE(made->error) << made->error->text();
  EXPECT_EQ(middle(*made), 0xff00ff00u) << "all fog";
  frame.read = []() -> Result<Picture> { return Error{ErrorKind::io, "has gone"}; };
  thumbnails.set_frame(frame);
  const auto without = wait_for(thumbnails, wanted);
  ASSERT_TRUE(without);
  EXPECT_TRUE(without->error) << "the picture as it was read";
}

TEST_F(ThumbnailsOfPresets, AnotherFrameAndAnotherWishThrowThemAway) {
  Thumbnails thumbnails({.device = "auto", .validate = true}, {}, [] {});
  thumbnails.set_frame(gray_frame());
  thumbnails.want({file("red"), file("plain")});
  ASSERT_TRUE(wait_for(thumbnails, "red"));
  thumbnails.set_frame(gray_frame(1));
  const auto later = wait_for(thumbnails, "plain");
  ASSERT_TRUE(later && !later->error);
  EXPECT_EQ(middle(*later), 0xffffffffu);
  thumbnails.want({file("plain")});
  EXPECT_EQ(thumbnails.find(file("red")), nullptr);
  thumbnails.rest();
  EXPECT_EQ(thumbnails.find(file("plain")), nullptr);
  EXPECT_FALSE(thumbnails.busy());
  thumbnails.set_frame(gray_frame());
  thumbnails.want({file("red")});
  const auto again = wait_for(thumbnails, "red");
  ASSERT_TRUE(again && !again->error);
  EXPECT_EQ(middle(*again), 0xff0000bcu) << "after a rest it goes on";
}

}  // namespace
}  // namespace afterglow
