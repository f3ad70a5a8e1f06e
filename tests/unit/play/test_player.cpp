// SPDX-License-Identifier: MIT
// A player shows frames as the clock says, those that come late and those that cannot be read, and what is in them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "player_test.h"

namespace afterglow {
namespace {

using ::testing::HasSubstr;

TEST(Percentiles, AreThoseOfTheSortedRow) {
  std::vector<double> row;
  for (int count = 1; count <= 250; ++count) {
    row.push_back((count * 7919) % 101);
    const Percentiles found = Percentiles::of(row);
    std::vector<double> sorted = row;
    std::ranges::sort(sorted);
    const auto at = [&](int percent) { return sorted[static_cast<std::size_t>((count * percent + 99) / 100 - 1)]; };
    EXPECT_EQ(found.median, at(50)) << count;
    EXPECT_EQ(found.p95, at(95)) << count;
    EXPECT_EQ(found.p99, at(99)) << count;
    EXPECT_EQ(found.most, sorted.back()) << count;
  }
  EXPECT_EQ(Percentiles::of({}).count, 0u);
}

TEST_F(PlayerTest, PlaysByTheClockAndRunsEachFrame) {
  write_sequence(3);
  Player& player = open();
  EXPECT_EQ(player.shown().position, -1);
  EXPECT_TRUE(turn().changed);
  EXPECT_FLOAT_EQ(source(), 0.125f);
  EXPECT_FLOAT_EQ(result(), 0.25f);
  player.transport().play(seconds_);
  for (const int number : {2, 3, 1, 2}) {
    seconds_ += 0.1;
    EXPECT_TRUE(turn().changed);
    EXPECT_EQ(player.shown().number, number);
    EXPECT_FLOAT_EQ(result(), static_cast<float>(number) / 4);
    EXPECT_FALSE(turn().changed) << "the same moment again";
  }
  EXPECT_EQ(player.stats().dropped, 0u);
  EXPECT_EQ(player.stats().shown, 5u);
  EXPECT_NEAR(player.stats().interval.median, 100, 1e-6);
  EXPECT_NEAR(player.stats().fps, 10, 1e-6);
}

TEST_F(PlayerTest, TellsWhichPicturesAreInMemory) {
  write_sequence(8);
  Player& all = open();
  turn();
  for (int i = 0; i < 8; ++i) EXPECT_EQ(all.frame_state(i), FrameState::cached) << i;
  PlayerOptions options;
  options.read_ahead.max_bytes = 1;
  Player& one = open(options);
  turn();
  EXPECT_EQ(one.frame_state(0), FrameState::cached) << "what is on screen is kept whatever it takes";
  EXPECT_EQ(one.frame_state(7), FrameState::unread);
}

TEST_F(PlayerTest, DropsWhatIsLate) {
  write_sequence(8);
  Player& player = open();
  turn();
  player.transport().play(seconds_);
  turn();
  seconds_ += 0.45;
  turn();
  EXPECT_EQ(player.shown().number, 5);
  EXPECT_EQ(player.stats().dropped, 3u);
}

/// As `run` reads them.
TEST_F(PlayerTest, PicturesAreOfTheSpaceThatTheLookSays) {
  write_picture_of(1, 0.5f);
  const auto write_space = [&](const std::string& name, const std::string& said) {
    write(name, "return require(\"afterglow\").stack { " + said + " }\n");
  };
  write_space("look.lua", "input_space = \"gamma22\"");
  open();
  turn();
  EXPECT_FLOAT_EQ(source(), std::pow(0.5f, 2.2f));
  write_space("look.lua", "input_space = \"gamma24\"");
  reload();
  EXPECT_FLOAT_EQ(source(), std::pow(0.5f, 2.4f));
  write_space("look.lua", "");
  reload();
  EXPECT_FLOAT_EQ(source(), 0.5f);
  EXPECT_THAT(warnings_, testing::IsEmpty());

  write_picture_of(1, -0.5f);
  write_space("look.lua", "gamut = \"keep\"");
  player_->reload_pictures();
  reload();
  EXPECT_FLOAT_EQ(source(), -0.5f);
  write_space("look.lua", "");
  reload();
  EXPECT_FLOAT_EQ(source(), 0);
  warnings_.clear();  // of light below 0
  write_picture_of(1, 0.5f);

  write_space("other.lua", "input_space = \"gamma24\"");
  PlayerOptions options;
  options.other_preset = path("other.lua");
  options.footage.read.input_space = "gamma22";  // --input-space
  open(options);
  turn();
  EXPECT_FLOAT_EQ(source(), std::pow(0.5f, 2.2f));
  EXPECT_THAT(warnings_, testing::IsEmpty());
  options.footage.read.input_space.clear();
  open(options);
  turn();
  EXPECT_FLOAT_EQ(source(), 0.5f) << "as the first look has it";
  EXPECT_THAT(warnings_, testing::ElementsAre(HasSubstr("input_space")));
}

TEST_F(PlayerTest, HeldFramesAreNotRunAgain) {
  write_picture_of(1, 0.125f);
  write_picture_of(3, 0.125f);  // another file with the same pixels
  Player& player = open();
  turn();
  const auto kept = player.stats().kept;
  player.transport().play(seconds_);
  seconds_ += 0.1;
  turn();
  EXPECT_EQ(player.shown().number, 2);
  EXPECT_TRUE(player.shown().held);
  EXPECT_EQ(player.stats().kept, kept + 1);
  seconds_ += 0.1;
  turn();
  EXPECT_EQ(player.shown().number, 3);
  EXPECT_FALSE(player.shown().held);
  EXPECT_EQ(player.stats().kept, kept + 2) << "no pass ran for it";
}

TEST_F(PlayerTest, AFrameThatCannotBeReadSaysSoAndPlayingGoesOn) {
  write_sequence(3);
  std::ofstream(path("s.2.exr")) << "broken";
  Player& player = open();
  turn();
  player.transport().play(seconds_);
  seconds_ += 0.1;
  EXPECT_TRUE(turn().changed);
  EXPECT_EQ(player.shown().number, 2);
  ASSERT_TRUE(player.shown().unreadable);
  EXPECT_THAT(player.shown().unreadable->file, HasSubstr("s.2.exr"));
  EXPECT_FLOAT_EQ(result(), 0.25f) << "the picture before stays";
  seconds_ += 0.1;
  turn();
  EXPECT_FALSE(player.shown().unreadable);
  EXPECT_FLOAT_EQ(result(), 0.75f);
  EXPECT_EQ(player.stats().unreadable, 1u);
  EXPECT_EQ(player.frames_had(), 3u);
  EXPECT_EQ(player.stats().shown, 2u);
}

TEST_F(PlayerTest, AnUnreadableFrameIsToldOnceAndEditsShowOnThePictureBefore) {
  write_sequence(3);
  std::ofstream(path("s.2.exr")) << "broken";
  Player& player = open();
  turn();
  player.transport().play(seconds_);
  seconds_ += 0.1;
  EXPECT_TRUE(turn().changed);
  player.transport().pause(seconds_);
  EXPECT_FALSE(turn().changed);
  write_look("look.lua", 2);
  EXPECT_TRUE(reload().changed);
  EXPECT_FLOAT_EQ(result(), 0.5f);
  EXPECT_TRUE(player.shown().unreadable);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(turn().changed) << i;
  EXPECT_EQ(player.stats().unreadable, 1u);
}

TEST_F(PlayerTest, ASecondLookThatFailsIsRunOnce) {
  write_sequence(2);
  write("other.lua",
        "local fx = require \"afterglow\"\nreturn fx.stack { fx.exposure { ev = function(t) "
        "if t.frame > 1 then error(\"not this one\") end return 1 end } }\n");
  PlayerOptions options;
  options.other_preset = path("other.lua");
  Player& player = open(options);
  player.view().compare = Compare::other;
  turn();
  player.transport().step(1, seconds_);
  EXPECT_TRUE(turn().changed);
  ASSERT_TRUE(player.shown().failed);
  EXPECT_THAT(player.shown().failed->text(), HasSubstr("not this one"));
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(turn().changed) << i;
}

TEST_F(PlayerTest, PicturesThatAreReadAgainAreShownWhenTheyCome) {
  write_sequence(1);
  Player& player = open();
  turn();
  write_picture_of(1, 0.375f);
  EXPECT_FALSE(turn().changed) << "pictures are not followed";
  player.reload_pictures();
  ASSERT_TRUE(player.step()) << "before it has come";
  turn();
  EXPECT_FLOAT_EQ(source(), 0.375f);
  EXPECT_FLOAT_EQ(result(), 0.75f);
}

TEST_F(PlayerTest, FramesThatAreStillRenderedAreShownAsTheyCome) {
  write_sequence(2);
  write_picture_of(5, 0.5f);
  follow_ = true;
  Player& player = open();
  turn();
  player.transport().go_to(2, seconds_);  // frame 3 is missing: 2 is held
  turn();
  EXPECT_TRUE(player.shown().held);
  EXPECT_FLOAT_EQ(source(), 0.25f);
  const auto until = [&](const std::function<bool()>& holds) {
    for (int i = 0; i < 2000 && !holds(); ++i) {
      player.wait(seconds_ + 1);
      turn();
    }
    return holds();
  };
  write_picture_of(3, 0.375f);
  EXPECT_TRUE(until([&] { return !player.shown().held; }));
  EXPECT_EQ(player.shown().number, 3);
  EXPECT_FLOAT_EQ(source(), 0.375f);
  write_picture_of(3, 0.75f);
  EXPECT_TRUE(until([&] { return source() == 0.75f; }));
  EXPECT_EQ(player.shown().number, 3);
  write_picture_of(7, 0.875f);
  EXPECT_TRUE(until([&] { return player.footage().frames() == 7; }));
  EXPECT_EQ(player.transport().last(), 6) << "what was all of it is all of it";
  EXPECT_EQ(player.shown().number, 3);
  write_picture_of(0, 0.0625f);  // one before: the frame that is shown stays
  EXPECT_TRUE(until([&] { return player.footage().frames() == 8; }));
  turn();
  EXPECT_EQ(player.shown().number, 3);
  EXPECT_EQ(player.transport().position(), 3);
  EXPECT_EQ(player.shown().position, 3);
  EXPECT_FLOAT_EQ(source(), 0.75f);
  player.transport().go_to(7, seconds_);
  turn();
  EXPECT_EQ(player.shown().number, 7);
  fs::remove(path("s.7.exr"));
  EXPECT_TRUE(until([&] { return player.footage().frames() < 8; }));
  EXPECT_LT(player.shown().position, player.footage().frames()) << "the frame that was shown is gone";
}

TEST_F(PlayerTest, ShowsImagesBetweenPasses) {
  write_sequence(1);
  Player& player = open();
  turn();
  player.show("source");
  turn();
  EXPECT_FLOAT_EQ(result(), 0.125f);
  player.show("");
  turn();
  EXPECT_FLOAT_EQ(result(), 0.25f);
}

TEST_F(PlayerTest, LooksAtValues) {
  write_sequence(1);
  Player& player = open();
  turn();
  EXPECT_FALSE(player.probe({-1, 0}).value());
  EXPECT_FALSE(player.probe({kSize.width, 0}).value());
  const Scopes result = player.scopes().value(), source = player.scopes({}, Player::Of::source).value();
  EXPECT_EQ(result.pixels, static_cast<std::uint64_t>(kSize.area()));
  EXPECT_EQ(result.most[1], 0.25f);
  EXPECT_EQ(source.most[1], 0.125f);
  EXPECT_EQ(player.scopes({.region = Rect{1, 1, 2, 3}}).value().pixels, 6u);
  const auto means = player.means({-5, 0, 7, 2}).value();
  ASSERT_TRUE(means);
  EXPECT_EQ(means->region, (Rect{0, 0, 2, 2}));
  EXPECT_EQ(means->source.mean[1], 0.125);
  EXPECT_EQ(means->result.mean[1], 0.25);
  EXPECT_EQ(means->result.pixels, 4u);
  EXPECT_FALSE(means->other);
  EXPECT_FALSE(player.means({kSize.width, 0, 4, 4}).value()) << "beside the picture";
  EXPECT_FLOAT_EQ(player.screenshot().value().color.pixels[0], 0.25f);
}

/// A look with one pass more in every second frame.
constexpr const char* kBlinking = R"(local fx = require "afterglow"
return fx.effect {
  name = "blink", at = "post_process", settings = {},
  build = function(g, s, source)
    local at = g:pass { shader = "blink/twice", source = source, name = "first" }
    if g.frame % 2 == 0 then at = g:pass { shader = "blink/twice", source = at, name = "second" } end
    return at
  end,
})";
constexpr const char* kTwice =
    "uniform sampler2D source;\nvec4 sample_at(ivec2 p) { return vec4(fetch(source, p).rgb * 2.0, 1); }\n";

TEST_F(PlayerTest, PassesThatComeAndGoAreBuiltBesideThePlaying) {
  write_sequence(3);
  fs::create_directories(folder_ / "effects");
  fs::create_directories(folder_ / "shaders" / "blink");
  write("effects/blink.lua", kBlinking);
  write("shaders/blink/twice.glsl", kTwice);
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.blink {} }\n");
  Player& player = open();
  turn();
  EXPECT_EQ(result(), 0.25f);
  player.transport().play(player.now());
  turn();
  seconds_ += 0.1;
  EXPECT_FALSE(turn().changed) << "the second frame has another pass, which is being built";
  EXPECT_EQ(player.shown().position, 0);
  EXPECT_EQ(result(), 0.25f);
  EXPECT_EQ(player.stats().rebuilding, 1u);
  EXPECT_TRUE(turn().changed);
  EXPECT_EQ(player.shown().position, 1);
  EXPECT_EQ(result(), 1.f);
  seconds_ += 0.1;
  EXPECT_TRUE(turn().changed);
  EXPECT_EQ(result(), 0.75f);
  for (int i = 0; i < 6; ++i) {  // from here on both are there
    seconds_ += 0.1;
    EXPECT_TRUE(turn().changed);
  }
  EXPECT_EQ(player.stats().rebuilding, 1u);
  EXPECT_EQ(player.stats().reloads, 0u) << "nothing was edited";
  EXPECT_EQ(player.stats().dropped, 0u);
}

TEST_F(PlayerTest, KernelsAreTimedWhenNothingElseIsToDo) {
  write_sequence(2);
  fs::create_directories(folder_ / "effects");
  fs::create_directories(folder_ / "shaders" / "blink");
  write("effects/blink.lua", kBlinking);
  write("shaders/blink/twice.glsl", kTwice);
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.blink {} }\n");
  Player& player = open();
  turn();
  const float before = result();
  EXPECT_TRUE(player.kernel_times().empty()) << "nobody has asked";
  player.time_kernels(true);
  int timed = 0;
  for (Step step = turn(); step.next <= player.now() || step.timed; step = turn()) timed += step.timed ? 1 : 0;
  EXPECT_EQ(timed, static_cast<int>(player.session().kernels().size()));
  EXPECT_EQ(player.kernel_times().size(), player.session().kernels().size());
  EXPECT_EQ(result(), before);
}

TEST_F(PlayerTest, ProxiesAreMeansRunWithTheirLengthsAndWrittenWhole) {
  Picture picture;
  picture.color = Image(16, 8, 4);
  const auto value = [](int x, int y) { return static_cast<float>(x + 16 * y) / 64; };
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x)
      for (int c = 0; c < 4; ++c) picture.color.at(x, y)[c] = c == 3 ? 1.0f : value(x, y);
  picture.data_window = picture.display_window = {0, 0, 16, 8};
  ASSERT_TRUE(write_picture(picture, path("s.1.exr"), {.type = SampleType::float32}, diagnostics_));
  fs::create_directories(folder_ / "effects");
  fs::create_directories(folder_ / "shaders");
  write("effects/length.lua",
        "local fx = require \"afterglow\"\nreturn fx.effect { name = \"length\", doc = \"Adds what a pixel is long.\", "
        "at = "
        "\"post_process\",\n  build = function(g, s, source)\n"
        "    return g:pass { shader = \"length\", source = source, pixel = g.length_scale }\n  end }\n");
  write("shaders/length.glsl",
        "uniform float pixel;\nvec4 apply(vec4 color) { return color + vec4(vec3(pixel), 0); }\n");
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { name = \"Look\", fx.length {} }\n");
  PlayerOptions options;
  options.footage.proxy = 2;
  Player& player = open(options);
  turn();
  EXPECT_EQ(player.shown().size, (Size{16, 8})) << "places are those of the whole picture";
  EXPECT_EQ(player.session().images().result.binding.size, (Size{8, 4}));
  const float mean = (value(6, 2) + value(7, 2) + value(6, 3) + value(7, 3)) / 4;
  for (const Pixel pixel : {Pixel{6, 2}, Pixel{7, 3}}) {
    const auto probe = player.probe(pixel).value();
    EXPECT_FLOAT_EQ(probe->source[0], mean);
    EXPECT_FLOAT_EQ(probe->result[0], mean + 0.5f);
  }
  const auto region = player.means({6, 2, 2, 2}).value();
  EXPECT_FLOAT_EQ(region->source.mean[0], mean);

  const auto written = player.screenshot();
  ASSERT_TRUE(written) << written.error().text();
  ASSERT_EQ(written->color.size(), (Size{16, 8}));
  EXPECT_FLOAT_EQ(written->color.at(6, 2)[0], value(6, 2) + 1);
  EXPECT_TRUE(turn().changed) << "the proxy comes back";
  EXPECT_FLOAT_EQ(player.probe({6, 2}).value()->result[0], mean + 0.5f);

  player.set_proxy(1);
  turn();
  EXPECT_FLOAT_EQ(player.probe({6, 2}).value()->source[0], value(6, 2));
  EXPECT_FLOAT_EQ(player.probe({6, 2}).value()->result[0], value(6, 2) + 1);
  EXPECT_EQ(player.shown().size, (Size{16, 8}));
}

TEST_F(PlayerTest, ProxiesHaveFourSizes) {
  EXPECT_EQ(parse_proxy("1").value(), 1);
  EXPECT_EQ(parse_proxy("1/8").value(), 8);
  for (const char* wrong : {"1/3", "2", "", "1/16", "half"}) {
    const auto parsed = parse_proxy(wrong);
    ASSERT_FALSE(parsed) << wrong;
    EXPECT_THAT(parsed.error().text(), HasSubstr("1, 1/2, 1/4, 1/8"));
  }
}

/// A file that says it is graded must be.
TEST_F(PlayerTest, WithoutALookThatRunsThereIsNoScreenshot) {
  write("look.lua", "return {");
  write_sequence(1);
  Player& player = open();
  turn();
  const auto picture = player.screenshot();
  ASSERT_FALSE(picture);
  EXPECT_THAT(picture.error().message, ::testing::HasSubstr("no version that runs yet"));
  write_look("look.lua", 1);
  reload();
  EXPECT_TRUE(player.screenshot());
}

}  // namespace
}  // namespace afterglow
