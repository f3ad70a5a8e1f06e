// SPDX-License-Identifier: MIT
// Sample shaders that tell where they are done: in one draw or in two, each pixel comes from the function that it
// should.
#include <gtest/gtest.h>

#include "workshop.h"

namespace afterglow {
namespace {

class TwoDraws : public Workshop {
 protected:
  void SetUp() override {
    Workshop::SetUp();
    // What is done twice is not the same: done_at doubles, sample_at turns the sign of what is left and of its
    // neighbour.
    shader("rest", R"(uniform sampler2D source;
uniform float limit;
bool done_at(ivec2 pixel, out vec4 color) {
  color = 2.0 * fetch(source, pixel);
  return color.r <= 2.0 * limit;
}
vec4 sample_at(ivec2 pixel) {
  vec4 sum = fetch(source, pixel) + fetch(source, pixel + ivec2(1, 0));
  for (int i = 0; float(i) < fetch(source, pixel).g; ++i) sum.b += 1.0;  // guarded: it stores
  return -sum;
}
)");
    shader("add", "vec4 apply(vec4 color) { return color + 1.0; }\n");
  }

  static Picture64 expected(const Picture64& source, double limit) {
    Picture64 out(source.size);
    for (int y = 0; y < source.size.height; ++y)
      for (int x = 0; x < source.size.width; ++x)
        for (int c = 0; c < 4; ++c) {
          const double own = source.get(x, y, c);
          double turns = 0;
          while (c == 2 && turns < source.get(x, y, 1)) ++turns;
          out.at(x, y, c) = source.get(x, y, 0) <= limit ? 2 * own : -(own + source.get(x + 1, y, c) + turns);
        }
    return out;
  }
};

TEST_F(TwoDraws, EachPixelComesFromTheFunctionThatItShould) {
  for (const Size size : kSizes)
    for (const double limit : {0.0, 0.5, 3.0, 100.0}) {  // nothing is done, some, all
      SCOPED_TRACE(testing::Message() << size.width << "x" << size.height << " " << limit);
      GraphBuilder builder(size);
      const Graph graph = builder.finish(
          builder.sample("rest", "rest", size, {{"source", builder.source()}}, {{"limit", number(limit)}}));
      const std::vector<float> source = noise(size, 11);
      const Picture64 truth = expected(Picture64::of(size, source), static_cast<float>(limit));
      for (const bool reference : {false, true}) {
        ProgramOptions options;
        options.reference = reference;
        const auto made = program(graph, options);
        EXPECT_EQ(made->config().two_draws, device().is_cpu() && !reference);
        const HostResult result = run(graph, {{"source", {.pixels = source.data(), .size = size}}}, options);
        expect_near(result.pixels, truth, 1e-6, reference ? "one draw" : "two draws");
      }
    }
}

/// What is asked first may leave something for what is done then.
TEST_F(TwoDraws, WhatOneFunctionLeavesInAVariableTheOtherFinds) {
  shader("kept", R"(uniform sampler2D source;
vec4 centre = vec4(0.0);
bool done_at(ivec2 pixel, out vec4 color) {
  color = centre = fetch(source, pixel);
  return color.r <= 0.5;
}
vec4 sample_at(ivec2 pixel) { return 4.0 * centre; }
)");
  const Size size{101, 57};
  GraphBuilder builder(size);
  const Graph graph = builder.finish(builder.sample("kept", "kept", size, {{"source", builder.source()}}));
  const std::vector<float> source = noise(size, 12);
  for (const bool reference : {false, true}) {
    ProgramOptions options;
    options.reference = reference;
    const HostResult result = run(graph, {{"source", {.pixels = source.data(), .size = size}}}, options);
    for (std::size_t i = 0; i < source.size(); ++i)
      ASSERT_EQ(result.pixels[i], (source[i / 4 * 4] <= 0.5f ? 1 : 4) * source[i]) << reference;
  }
}

/// Kernels of other sizes share the image that tells their draws apart; what follows in a kernel is done to all pixels.
TEST_F(TwoDraws, SeveralKernelsOneBehindTheOther) {
  const Size first{101, 57}, second{37, 90};
  GraphBuilder builder(first);
  const ImageId a = builder.sample("a", "rest", first, {{"source", builder.source()}}, {{"limit", number(1)}});
  const ImageId b = builder.sample("b", "rest", second, {{"source", a}}, {{"limit", number(-2)}});
  const Graph graph = builder.finish(builder.pixel("add", "add", b));
  const std::vector<float> source = noise(first, 5);
  const Picture64 of_a = expected(Picture64::of(first, source), 1);
  Picture64 truth(second);
  for (int y = 0; y < second.height; ++y)
    for (int x = 0; x < second.width; ++x)
      for (int c = 0; c < 4; ++c) {
        double turns = 0;
        while (c == 2 && turns < of_a.get(x, y, 1)) ++turns;
        const double own = of_a.get(x, y, c), next = of_a.get(x + 1, y, c);
        truth.at(x, y, c) = 1 + (of_a.get(x, y, 0) <= -2 ? 2 * own : -(own + next + turns));
      }
  const HostResult result = run(graph, {{"source", {.pixels = source.data(), .size = first}}});
  expect_near(result.pixels, truth, 1e-5, "two kernels");
}

TEST_F(TwoDraws, APartOfThePictureIsTheCropOfTheWhole) {
  const Size size{101, 57};
  GraphBuilder builder(size);
  const Graph graph =
      builder.finish(builder.sample("rest", "rest", size, {{"source", builder.source()}}, {{"limit", number(1)}}));
  const std::vector<float> source = noise(size, 23);
  const HostResult whole = run(graph, {{"source", {.pixels = source.data(), .size = size}}});
  ProgramOptions options;
  options.region = Rect{13, 7, 40, 33};
  const HostResult part = run(graph, {{"source", {.pixels = source.data(), .size = size}}}, options);
  for (int y = 7; y < 40; ++y)
    for (int x = 13; x < 53; ++x)
      for (int c = 0; c < 4; ++c) {
        const std::size_t at = (static_cast<std::size_t>(y) * 101 + static_cast<std::size_t>(x)) * 4 + c;
        ASSERT_EQ(part.pixels[at], whole.pixels[at]) << x << " " << y;
      }
}

}  // namespace
}  // namespace afterglow
