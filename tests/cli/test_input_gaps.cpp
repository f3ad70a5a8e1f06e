// SPDX-License-Identifier: MIT
// Single frames of a sequence that lack an input, or whose overscan is another than that of the rest.
#include <nlohmann/json.hpp>

#include "layers_test.h"

namespace afterglow::test {
namespace {

class InputGaps : public LayersTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    make_depth_look("look.lua");
    make_depth_look("optional.lua", "required = false, ");
    for (int frame = 1; frame <= 6; ++frame) {
      auto channels = colours("", 0.25f);
      if (frame != 1 && frame != 4 && frame != 5) channels["Z"] = 9;
      make_layers(file(frame), {{channels, "", ""}});
    }
    fs::create_directory(path("out"));
  }
  static std::string file(int frame, const std::string& folder = "in") {
    return folder + "/s.000" + std::to_string(frame) + ".exr";
  }
  Outcome make(const std::string& look, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"run", look, "in/s.####.exr", "-o", "out/"};
    all.insert(all.end(), more.begin(), more.end());
    return run(all);
  }
  bool made(int frame) const { return fs::exists(path(file(frame, "out"))); }
};

TEST_F(InputGaps, FramesThatLackWhatOthersHaveFailAndAreToldAtOnce) {
  const Outcome outcome = make("look.lua", {"--report", "report.json"});
  EXPECT_EQ(outcome.exit_code, kFiles);
  EXPECT_EQ(outcome.err,
            "in/s.*.exr: error: frames 1,4-5: no depth, which 'color_adjustments' needs and other frames have, as "
            "s.0002.exr; required = false in its entry makes such frames without it\n"
            "error: 3 of 6 frames failed\n");
  for (const int frame : {1, 4, 5}) EXPECT_FALSE(made(frame)) << frame;
  for (const int frame : {2, 3, 6}) EXPECT_FLOAT_EQ(pixels_of(file(frame, "out")).at(0), 0.5f) << frame;
  const auto report = nlohmann::json::parse(read("report.json"));
  EXPECT_EQ(report.at("frames").at(3).at("state"), "failed");
  EXPECT_THAT(report.at("frames").at(3).at("error").get<std::string>(), HasSubstr("has no depth"));
}

TEST_F(InputGaps, ResumeDoesNotMakeThemEither) {
  EXPECT_EQ(make("look.lua", {"--resume"}).exit_code, kFiles);
  const Outcome again = make("look.lua", {"--resume"});
  EXPECT_EQ(again.exit_code, kFiles);
  EXPECT_THAT(again.err, HasSubstr("frames 1,4-5: no depth"));
  EXPECT_FALSE(made(4));
  for (const int frame : {1, 4}) make_layers(file(frame), {{with(colours("", 0.25f), {{"Z", 9}}), "", ""}});
  EXPECT_EQ(make("look.lua", {"--resume"}).exit_code, kFiles);
  EXPECT_TRUE(made(4));
  const Outcome last = make("look.lua", {"--resume"});
  EXPECT_EQ(last.exit_code, kFiles);
  EXPECT_THAT(last.err, HasSubstr("in/s.0005.exr: error: has no depth"));
}

TEST_F(InputGaps, ALookMayDoWithout) {
  const Outcome outcome = make("optional.lua");
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_EQ(outcome.err,
            "warning: in/s.*.exr: frames 1,4-5: no depth, which other frames have, as s.0002.exr: 'color_adjustments' "
            "was skipped\n");
  EXPECT_FLOAT_EQ(pixels_of(file(4, "out")).at(0), 0.25f);
  EXPECT_FLOAT_EQ(pixels_of(file(6, "out")).at(0), 0.5f);
}

TEST_F(InputGaps, WhatNoFrameHasIsSkippedWithOneWarning) {
  for (const std::string look : {"look.lua", "optional.lua"}) {
    const Outcome outcome = make(look, {"--frames", "4,5"});
    EXPECT_EQ(outcome.exit_code, kDone);
    EXPECT_EQ(outcome.err, "warning: effect 'color_adjustments' is skipped: no depth input\n");
  }
  const Outcome stills = run({"run", "look.lua", file(1), "-o", "out.exr"});
  EXPECT_EQ(stills.exit_code, kDone);
  EXPECT_EQ(stills.err, "warning: effect 'color_adjustments' is skipped: no depth input\n");
}

TEST_F(InputGaps, OtherOverscanIsTold) {
  for (int frame = 1; frame <= 5; ++frame) {
    const bool wide = frame == 2 || frame == 3;
    OIIO::ImageSpec spec(wide ? 40 : 32, wide ? 32 : 24, 3, OIIO::TypeDesc::HALF);
    spec.x = spec.y = wide ? -4 : 0;
    spec.full_x = spec.full_y = 0;
    spec.full_width = 32;
    spec.full_height = 24;
    const std::vector<float> pixels(static_cast<std::size_t>(spec.width) * spec.height * 3, 0.25f);
    const std::string name = text("over.000" + std::to_string(frame) + ".exr");
    auto out = OIIO::ImageOutput::create(name);
    ASSERT_TRUE(out && out->open(name, spec) && out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && out->close());
  }
  make_preset("plain.lua");
  const Outcome outcome = run({"run", "plain.lua", "over.####.exr", "-o", "out/"});
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_THAT(outcome.err,
              HasSubstr("over.*.exr: frames 2-3: the overscan is another than in other frames, which have none: "));
  EXPECT_EQ(pixels_of("out/over.0002.exr").size(), 40u * 32 * 3);
  const Outcome cut = run({"run", "plain.lua", "over.####.exr", "-o", "out/", "--overscan", "cut"});
  EXPECT_EQ(cut.err, "");
  EXPECT_EQ(pixels_of("out/over.0002.exr").size(), 32u * 24 * 3);
}

}  // namespace
}  // namespace afterglow::test
