// SPDX-License-Identifier: MIT
// Every kind of kernel against plain double-precision arithmetic.
#include <fmt/format.h>

#include <cmath>

#include "workshop.h"

namespace afterglow {
namespace {

struct Variant {
  const char* name;
  Storage storage;
  bool reference, direct;
  double tolerance;
};

const Variant kVariants[] = {{"fp32", Storage::fp32, false, true, 1e-5},
                             {"fp32 reference", Storage::fp32, true, true, 1e-5},
                             {"fp32 staged", Storage::fp32, false, false, 1e-5},
                             {"fp16", Storage::fp16, false, true, 2e-3},
                             {"fp16 staged", Storage::fp16, false, false, 2e-3}};

class KernelTest : public Workshop {
 protected:
  /// Runs `build`'s graph at all sizes in all variants and compares with `expect`. Without `halves` where channels are
  /// mixed: a bright one's rounding is more than another's tolerance.
  void compare(const std::function<ImageId(GraphBuilder&, Size)>& build,
               const std::function<Picture64(const Picture64&)>& expect, bool halves = true) {
    for (const Size size : kSizes) {
      const auto pixels = noise(size, 7u + size.width);
      const Picture64 expected = expect(Picture64::of(size, pixels));
      GraphBuilder builder(size);
      const ImageId result = build(builder, size);
      const Graph graph = builder.finish(result);
      for (const auto& variant : kVariants) {
        if (variant.storage == Storage::fp16 && !halves) continue;
        const auto out = run(graph, {{"source", {pixels.data(), size, 4}}},
                             {.config = {.storage = variant.storage}, .reference = variant.reference}, variant.direct);
        expect_near(out.pixels, expected, variant.tolerance,
                    fmt::format("{}×{} {}", size.width, size.height, variant.name));
      }
    }
  }
};

TEST_F(KernelTest, CopyGivesTheVeryPixels) {
  shader("copy", "vec4 apply(vec4 color) { return color; }\n");
  for (const Size size : kSizes) {
    const auto pixels = noise(size, 3);
    GraphBuilder builder(size);
    const Graph graph = builder.finish(builder.pixel("copy", "copy", builder.source()));
    EXPECT_EQ(run(graph, {{"source", {pixels.data(), size, 4}}}).pixels, pixels);
    EXPECT_EQ(run(graph, {{"source", {pixels.data(), size, 4}}}, {}, false).pixels, pixels);
  }
}

TEST_F(KernelTest, PixelWithParametersOfAllTypes) {
  shader("mixed", R"(
    uniform float gain;
    uniform vec3 tint;
    uniform vec2 shift;
    uniform bool invert;
    uniform int steps;
    layout(constant_id = 0) const bool square = false;
    vec4 apply(vec4 color) {
      vec3 c = color.rgb * gain * tint;
      c.rg += shift;
      if (invert) c = 1.0 / (1.0 + c);
      if (square) c *= c;
      return vec4(c * float(steps), color.a);
    })");
  const auto build = [](GraphBuilder& b, Size) {
    return b.pixel("mixed", "mixed", b.source(), {},
                   {{"gain", number(1.5)},
                    {"tint", vector({0.5, 2, 0.25})},
                    {"shift", vector({0.125, 0.75})},
                    {"invert", {ParamType::bool1, {1}}},
                    {"steps", {ParamType::int1, {-3}}}},
                   {{"square", 1}});
  };
  compare(build, [](const Picture64& in) {
    Picture64 out = in;
    const double tint[] = {0.5, 2, 0.25}, shift[] = {0.125, 0.75, 0};
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
      if (i % 4 == 3) continue;
      const double c = 1 / (1 + out.pixels[i] * 1.5 * tint[i % 4] + shift[i % 4]);
      out.pixels[i] = -3 * c * c;
    }
    return out;
  });
}

/// Parts of them too: a column, an element at a place that the picture says, an array handed to a function.
TEST_F(KernelTest, PixelWithMatricesAndArrays) {
  shader("turned", R"(
    uniform float before;
    uniform mat3 turn;
    uniform mat2 small;
    uniform mat4 all;
    uniform float weights[5];
    uniform vec3 tints[3];
    uniform ivec2 steps[2];
    uniform float behind;
    float sum(float of[5]) { return of[0] + of[1] + of[2] + of[3] + of[4]; }
    vec4 apply(vec4 color, ivec2 pixel) {
      vec4 c = all * vec4(turn * color.rgb, 1.0);
      c.rg = small * c.rg + turn[1].xy;
      int third = (pixel.x + pixel.y) % 3;
      c.rgb += tints[third] * weights[third + 2] + small[1][0] + all[3].z;
      return vec4(c.rgb * (before + behind) + float(steps[1].x) + sum(weights), color.a);
    })");
  const double turn[3][3] = {{0.5, 0.25, 0.125}, {-0.25, 1, 0.5}, {0.75, 0, 1}};  // rows
  const double all[4][4] = {{1, 0, 0.5, 0.25}, {0, 1, 0, -0.5}, {0.25, 0, 1, 0.125}, {0, 0, 0, 1}};
  const double small[2][2] = {{1, 0.5}, {-0.5, 0.25}};
  const double weights[5] = {1, 2, 0.5, 0.25, 0.125};
  const double tints[3][3] = {{1, 2, 3}, {0.5, 0.25, 0}, {-1, 0, 1}};
  const auto columns = [](const auto& rows) {
    std::vector<double> out;
    for (std::size_t c = 0; c < std::size(rows); ++c)
      for (const auto& row : rows) out.push_back(row[c]);
    return out;
  };
  const auto in_order = [](const auto& rows) {
    std::vector<double> out;
    for (const auto& row : rows) out.insert(out.end(), std::begin(row), std::end(row));
    return out;
  };
  const auto build = [&](GraphBuilder& b, Size) {
    return b.pixel("turned", "turned", b.source(), {},
                   {{"before", number(0.75)},
                    {"behind", number(-0.25)},
                    {"turn", {ParamType::matrix3, columns(turn)}},
                    {"small", {ParamType::matrix2, columns(small)}},
                    {"all", {ParamType::matrix4, columns(all)}},
                    {"weights", {ParamType::float1, {std::begin(weights), std::end(weights)}, 5}},
                    {"tints", {ParamType::float3, in_order(tints), 3}},
                    {"steps", {ParamType::int2, {1, 2, 3, 4}, 2}}});
  };
  compare(
      build,
      [&](const Picture64& in) {
        Picture64 out = in;
        for (std::size_t i = 0; i < out.pixels.size(); i += 4) {
          const double* color = &in.pixels[i];
          double turned[4] = {0, 0, 0, 1}, c[4] = {};
          for (int row = 0; row < 3; ++row)
            for (int k = 0; k < 3; ++k) turned[row] += turn[row][k] * color[k];
          for (int row = 0; row < 4; ++row)
            for (int k = 0; k < 4; ++k) c[row] += all[row][k] * turned[k];
          const double r = small[0][0] * c[0] + small[0][1] * c[1] + turn[0][1];
          const double g = small[1][0] * c[0] + small[1][1] * c[1] + turn[1][1];
          c[0] = r;
          c[1] = g;
          const int at = static_cast<int>(i / 4), third = (at % in.size.width + at / in.size.width) % 3;
          for (int k = 0; k < 3; ++k) {
            c[k] += tints[third][k] * weights[third + 2] + small[0][1] + all[2][3];
            out.pixels[i + static_cast<std::size_t>(k)] = c[k] * 0.5 + 3 + 3.875;
          }
        }
        return out;
      },
      false);
}

TEST_F(KernelTest, SampleReadsNeighboursAndSizes) {
  shader("edges", R"(
    uniform sampler2D image;
    uniform float gain;
    vec4 sample_at(ivec2 pixel) {
      vec4 here = fetch(image, pixel);
      vec4 d = abs(fetch(image, pixel + ivec2(1, 0)) - here) + abs(fetch(image, pixel + ivec2(0, -1)) - here);
      return here + gain * d + vec4(vec2(image_size(image)) / vec2(target_size()), 0.0, 0.0);
    })");
  const auto build = [](GraphBuilder& b, Size size) {
    return b.sample("edges", "edges", size, {{"image", b.source()}}, {{"gain", number(0.25)}});
  };
  compare(build, [](const Picture64& in) {
    Picture64 out(in.size);
    for (int y = 0; y < in.size.height; ++y) {
      for (int x = 0; x < in.size.width; ++x) {
        for (int c = 0; c < 4; ++c) {
          const double here = in.get(x, y, c);
          out.at(x, y, c) = here +
                            0.25 * (std::abs(in.get(x + 1, y, c) - here) + std::abs(in.get(x, y - 1, c) - here)) +
                            (c < 2 ? 1 : 0);
        }
      }
    }
    return out;
  });
}

TEST_F(KernelTest, SampleWithoutImagesAndParameters) {
  shader("pattern",
         "vec4 sample_at(ivec2 pixel) { return vec4(vec2(pixel) / 256.0, vec2(target_size()) / 1024.0); }\n");
  const auto build = [](GraphBuilder& b, Size size) { return b.sample("pattern", "pattern", size, {}); };
  compare(build, [](const Picture64& in) {
    Picture64 out(in.size);
    for (int y = 0; y < in.size.height; ++y) {
      for (int x = 0; x < in.size.width; ++x) {
        const double values[] = {x / 256.0, y / 256.0, in.size.width / 1024.0, in.size.height / 1024.0};
        for (int c = 0; c < 4; ++c) out.at(x, y, c) = values[c];
      }
    }
    return out;
  });
}

Filter gaussian() {
  Filter filter;
  filter.x.clear();
  const double weights[] = {0.01621622, 0.05405405, 0.12162162, 0.19459459, 0.22702703};
  for (int i = -4; i <= 4; ++i) filter.x.push_back({2.0 * i, weights[4 - std::abs(i)]});
  return filter;
}

Size halved(Size size) { return {std::max(1, size.width / 2), std::max(1, size.height / 2)}; }

/// A filter down to half size and back up by a pixel pass that keeps the graph's sizes valid: down, then up to the
/// source's size.
TEST_F(KernelTest, FiltersDownAndUp) {
  Filter spline;
  spline.interpolation = Interpolation::cubic_bspline;
  Filter fractional;
  fractional.y = {{-1.38461538, 0.3}, {0, 0.4}, {1.38461538, 0.3}};
  Filter plus;
  plus.taps = {{1, 0, 0.25}, {-1, 0, 0.25}, {0, 1, 0.25}, {0, -1, 0.25}};
  Filter nearest;
  nearest.interpolation = Interpolation::nearest;
  const std::pair<const char*, std::pair<Filter, Filter>> cases[] = {{"gaussian, b-spline", {gaussian(), spline}},
                                                                     {"fractional, bilinear", {fractional, Filter{}}},
                                                                     {"plus, plus", {plus, plus}},
                                                                     {"nearest, gaussian", {nearest, gaussian()}}};
  for (const auto& [name, filters] : cases) {
    SCOPED_TRACE(name);
    const auto& [down, up] = filters;
    compare([&](GraphBuilder& b,
                Size size) { return b.filter("up", b.filter("down", b.source(), halved(size), down), size, up); },
            [&](const Picture64& in) { return filter64(filter64(in, down, halved(in.size)), up, in.size); });
  }
}

TEST_F(KernelTest, ExtremeAspectRatios) {
  Filter spline;
  spline.interpolation = Interpolation::cubic_bspline;
  for (const Size size : {Size{16384, 1}, Size{1, 16384}, Size{16383, 3}}) {
    const auto pixels = noise(size, 9);
    GraphBuilder b(size);
    const Graph graph = b.finish(b.filter("up", b.filter("down", b.source(), halved(size), gaussian()), size, spline));
    const Picture64 expected = filter64(filter64(Picture64::of(size, pixels), gaussian(), halved(size)), spline, size);
    for (const bool direct : {true, false}) {
      const auto out = run(graph, {{"source", {pixels.data(), size, 4}}}, {}, direct);
      expect_near(out.pixels, expected, 1e-5, fmt::format("{}×{}", size.width, size.height));
    }
  }
}

TEST_F(KernelTest, FilteredFetchesStayWithinTheirOwnTolerance) {
  const Size size{101, 57};
  const auto pixels = noise(size, 10);
  GraphBuilder b(size);
  const Graph graph = b.finish(b.filter("up", b.filter("down", b.source(), halved(size), gaussian()), size, {}));
  const Picture64 expected = filter64(filter64(Picture64::of(size, pixels), gaussian(), halved(size)), {}, size);
  const std::map<std::string, HostImage> inputs{{"source", {pixels.data(), size, 4}}};
  const auto filtered = run(graph, inputs, {.config = {.hardware_filter = true}});
  expect_near(filtered.pixels, expected, 5e-3, "filtered fetches");
  // The reference never uses them, whatever it is asked.
  const auto reference = run(graph, inputs, {.config = {.hardware_filter = true}, .reference = true});
  expect_near(reference.pixels, expected, 1e-5, "reference");
}

TEST_F(KernelTest, PixelStagesJoinTheFilterBeforeThem) {
  shader("add", "uniform float amount;\nvec4 apply(vec4 color, vec4 high) { return high + amount * color; }\n");
  shader("curve", "vec4 apply(vec4 color) { return vec4(color.rgb / (1.0 + color.rgb), color.a); }\n");
  const auto build = [](GraphBuilder& b, Size size) {
    const ImageId low = b.filter("down", b.source(), halved(size), Filter{});
    const ImageId up = b.filter("up", low, size, Filter{});
    return b.pixel("curve", "curve", b.pixel("add", "add", up, {{"high", b.source()}}, {{"amount", number(0.5)}}));
  };
  compare(build, [](const Picture64& in) {
    Picture64 out = filter64(filter64(in, {}, halved(in.size)), {}, in.size);
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
      out.pixels[i] = in.pixels[i] + 0.5 * out.pixels[i];
      if (i % 4 != 3) out.pixels[i] /= 1 + out.pixels[i];
    }
    return out;
  });
  GraphBuilder builder({64, 64});
  const ImageId result = build(builder, {64, 64});
  const auto fused = program(builder.finish(result));
  ASSERT_EQ(fused->plan().kernels.size(), 2u);
  EXPECT_EQ(fused->plan().kernels[1].name, "up+add+curve");
}

TEST_F(KernelTest, AuxiliaryImagesOfOneAndThreeChannels) {
  shader("fog", R"(
    uniform sampler2D depth;
    uniform sampler2D normal;
    uniform sampler2D image;
    vec4 sample_at(ivec2 pixel) { return fetch(image, pixel) + fetch(depth, pixel).r * vec4(fetch(normal, pixel).xyz, fetch(normal, pixel).a); })");
  for (const Size size : kSizes) {
    for (const bool direct : {true, false}) {
      const auto pixels = noise(size, 1), depth = noise(size, 2, 1), normal = noise(size, 3, 3);
      GraphBuilder b(size);
      const ImageId d = b.auxiliary("depth", size), n = b.auxiliary("normal", size);
      const Graph graph = b.finish(b.sample("fog", "fog", size, {{"depth", d}, {"normal", n}, {"image", b.source()}}));
      const auto out = run(graph,
                           {{"source", {pixels.data(), size, 4}},
                            {"depth", {depth.data(), size, 1}},
                            {"normal", {normal.data(), size, 3}}},
                           {}, direct);
      Picture64 expected = Picture64::of(size, pixels);
      for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
        const double factor = i % 4 == 3 ? 1.0 : static_cast<double>(normal[i / 4 * 3 + i % 4]);
        expected.pixels[i] += static_cast<double>(depth[i / 4]) * factor;
      }
      expect_near(out.pixels, expected, 1e-5, fmt::format("{}×{}", size.width, size.height));
    }
  }
}

}  // namespace
}  // namespace afterglow
