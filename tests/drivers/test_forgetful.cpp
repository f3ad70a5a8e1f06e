// SPDX-License-Identifier: MIT
// What stays on a device that keeps nothing which it need not keep (forgetful_layer.cpp).
#include <cstdlib>

#include "workshop.h"

namespace afterglow {
namespace {

/// Before the loader looks.
const bool layered = [] {
  setenv("VK_ADD_LAYER_PATH", AFTERGLOW_LAYER_FOLDER, 1);
  setenv("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation:VK_LAYER_AFTERGLOW_forgetful", 1);
  return true;
}();

class Forgetful : public Workshop {
 protected:
  void SetUp() override {
    Workshop::SetUp();
    shader("test/gain", "uniform float gain;\nvec4 apply(vec4 color) { return vec4(color.rgb * gain, color.a); }\n");
    shader("test/sum", "vec4 apply(vec4 color, vec4 other) { return color + other; }\n");
  }
  /// Shows the frame before beside the picture, and keeps the picture times `gain` for the next.
  static Graph looks_back(double gain) {
    GraphBuilder builder(kSize);
    const ImageId before = builder.auxiliary("before", kSize);
    const ImageId kept = builder.pixel("keep", "test/gain", builder.source(), {}, {{"gain", number(gain)}});
    const ImageId shown = builder.pixel("show", "test/sum", builder.source(), {{"other", before}});
    Graph graph = builder.finish(shown);
    graph.auxiliary.clear();  // no host gives it
    graph.histories.push_back(
        {.name = "past", .effect = "", .previous = before, .next = kept, .initial = {1, 1, 1, 1}});
    return graph;
  }
  static constexpr Size kSize{37, 21};
};

/// Of a frame that is shown again, only what is kept for the next one may have changed.
TEST_F(Forgetful, AResultThatIsNotMadeAnewStays) {
  for (const bool direct : {false, true}) {
    auto pixels = noise(kSize, 3);
    const std::map<std::string, HostImage> inputs{
        {"source", {.pixels = pixels.data(), .size = kSize, .channels = 4, .content = Hash{1, 1}}}};
    const auto made = program(looks_back(1), {.keep_images = true});
    auto runner = FrameRunner::create(device(), 1u << 30, direct);
    ASSERT_TRUE(runner);
    HostResult first, again;
    ASSERT_TRUE((*runner)->run(*made, inputs, first, KernelTiming::none));
    EXPECT_TRUE(made->set_parameters(looks_back(0.5)));
    const auto times = (*runner)->run(*made, inputs, again, KernelTiming::none);
    ASSERT_TRUE(times);
    EXPECT_EQ(times->kernels_run, 1);
    EXPECT_EQ(times->kernels_kept, 1);
    EXPECT_FLOAT_EQ(first.pixels[0], pixels[0] + 1);
    EXPECT_EQ(first.pixels, again.pixels) << direct;
  }
}

}  // namespace
}  // namespace afterglow
