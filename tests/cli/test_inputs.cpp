// SPDX-License-Identifier: MIT
// Which channels of multi-layer and stereo EXRs the inputs beside the picture are taken from, and what is told of it.
#include <nlohmann/json.hpp>

#include "layers_test.h"

namespace afterglow::test {
namespace {

class Inputs : public LayersTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    make_depth_look("look.lua");
  }
  Outcome make(const std::string& file, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"run", "look.lua", file, "-o", "out.exr"};
    all.insert(all.end(), more.begin(), more.end());
    return run(all);
  }
  float red() const { return pixels_of("out.exr").at(0); }
  static std::map<std::string, float> eye(float colour, float depth) {
    return with(colours("ViewLayer.Combined.", colour), {{"ViewLayer.Depth.Z", depth}});
  }
};

TEST_F(Inputs, DepthOfAnotherViewLayerIsNotTakenButNamed) {
  make_layers("a.exr", {{with(with(colours("fg.Combined.", 0.25f), colours("bg.Combined.", 0.5f)), {{"bg.Depth.Z", 9}}),
                         "", ""}});
  const Outcome own = make("a.exr", {"--layer", "bg"});
  EXPECT_EQ(own.exit_code, kDone);
  EXPECT_EQ(own.err, "");
  EXPECT_FLOAT_EQ(red(), 1.0f);
  const Outcome other = make("a.exr", {"--layer", "fg"});
  EXPECT_EQ(other.exit_code, kDone);
  EXPECT_THAT(other.err,
              HasSubstr("no depth input; 'bg.Depth.Z' of the picture may be meant: --depth bg.Depth.Z takes it"));
  EXPECT_FLOAT_EQ(red(), 0.25f);
  EXPECT_EQ(make("a.exr", {"--layer", "fg", "--depth", "bg.Depth.Z"}).err, "");
  EXPECT_FLOAT_EQ(red(), 0.5f) << "it is asked for";
  const Outcome first = make("a.exr");
  EXPECT_THAT(first.err,
              HasSubstr("'bg.Combined' is taken of the layers bg.Combined, fg.Combined; --layer says another"));
}

TEST_F(Inputs, EachEyeHasItsOwnDepth) {
  make_layers("stereo.exr", {{eye(0.25f, 3), "left", "left"}, {eye(0.5f, 9), "right", "right"}});
  EXPECT_EQ(make("stereo.exr", {"--layer", "right"}).err, "");
  EXPECT_FLOAT_EQ(red(), 1.0f);
  EXPECT_EQ(make("stereo.exr", {"--layer", "left"}).err, "");
  EXPECT_FLOAT_EQ(red(), 0.25f);
  make_layers("half.exr", {{colours("ViewLayer.Combined.", 0.25f), "left", "left"}, {eye(0.5f, 9), "right", "right"}});
  EXPECT_THAT(make("half.exr", {"--layer", "left"}).err, HasSubstr("--depth right.ViewLayer.Depth.Z takes it"));
  EXPECT_FLOAT_EQ(red(), 0.25f);
}

TEST_F(Inputs, OneOfTwoThatAreAsNearIsTakenAndBothAreNamed) {
  make_layers("a.exr", {{with(colours("", 0.5f), {{"depth.Z", 9}, {"zdepth.Z", 3}}), "", ""}});
  const Outcome outcome = make("a.exr");
  EXPECT_EQ(outcome.err,
            "warning: a.exr: depth is taken from 'depth.Z', the first in the file; 'zdepth.Z' would do as well; "
            "--depth zdepth.Z takes it\n");
  EXPECT_FLOAT_EQ(red(), 1.0f);
  EXPECT_EQ(make("a.exr", {"--depth", "zdepth.Z"}).err, "");
  EXPECT_FLOAT_EQ(red(), 0.5f);
}

TEST_F(Inputs, ChannelsAreToldByVerboseAndReport) {
  make_layers("stereo.exr", {{eye(0.25f, 3), "left", "left"}, {eye(0.5f, 9), "right", "right"}});
  const Outcome outcome = make("stereo.exr", {"--layer", "right", "-v", "--report", "report.json"});
  EXPECT_THAT(outcome.err, HasSubstr("stereo.exr: taken of the channels: color right.ViewLayer.Combined.RGB, depth "
                                     "right.ViewLayer.Depth.Z"));
  const auto report = nlohmann::json::parse(read("report.json"));
  EXPECT_EQ(report.at("frames").at(0).at("channels"),
            (nlohmann::json{{"color", "right.ViewLayer.Combined.RGB"}, {"depth", "right.ViewLayer.Depth.Z"}}));
}

}  // namespace
}  // namespace afterglow::test
