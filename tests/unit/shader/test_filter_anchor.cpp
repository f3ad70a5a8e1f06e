// SPDX-License-Identifier: MIT
// The GLSL made for filters: how many texels it reads, that it is valid SPIR-V for every combination, what is refused.
#include <gmock/gmock.h>

#include <cmath>
#include <spirv-tools/libspirv.hpp>

#include "shader_files.h"

namespace afterglow {
namespace {

using testing::HasSubstr;
using testing::Not;
using enum AxisRatio;

constexpr auto kNearest = Interpolation::nearest;
constexpr auto kLinear = Interpolation::linear;
constexpr auto kCubic = Interpolation::cubic_bspline;

KernelDesc kernel(Filter filter, AxisRatio ratio_x, AxisRatio ratio_y, bool hardware_filter = false) {
  KernelDesc desc;
  desc.filter = std::move(filter);
  desc.ratio_x = ratio_x;
  desc.ratio_y = ratio_y;
  desc.config.hardware_filter = hardware_filter;
  return desc;
}

/// From the anchor's function on.
std::string main_of(const KernelDesc& desc) {
  const auto assembled = assemble(desc);
  if (!assembled) return assembled.error().text();
  return assembled->glsl.substr(std::min(assembled->glsl.find("vec4 ag_filter("), assembled->glsl.find("void main()")));
}

int count(const std::string& text, const std::string& word) {
  int found = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

int texels(const KernelDesc& desc) { return count(main_of(desc), "ag_texel0("); }
int fetches(const KernelDesc& desc) { return count(main_of(desc), "textureLod("); }

std::vector<Tap> gaussian_halving() {
  const double w[] = {0.01621622, 0.05405405, 0.12162162, 0.19459459, 0.22702703};
  std::vector<Tap> taps;
  for (int i = -4; i <= 4; ++i) taps.push_back({2.0 * i, w[4 - std::abs(i)]});
  return taps;
}

const Filter kPlus{kLinear, {{0, 1}}, {{0, 1}}, {{1, 0, 0.25}, {0, 1, 0.25}, {-1, 0, 0.25}, {0, -1, 0.25}}};

TEST(FilterAnchor, TexelsAreMergedWhereTheRatioFixesThem) {
  EXPECT_EQ(texels(kernel({kLinear}, same, same)), 1);
  EXPECT_EQ(texels(kernel({kLinear}, half, half)), 4);
  EXPECT_EQ(texels(kernel({kLinear}, same, half)), 2);
  EXPECT_EQ(texels(kernel({kLinear}, twice, twice)), 4);
  EXPECT_EQ(texels(kernel({kLinear}, any, any)), 4);
  EXPECT_EQ(texels(kernel({kNearest}, any, half)), 1);
  EXPECT_EQ(texels(kernel({kCubic}, same, same)), 9) << "the fourth weight is zero at texel centres";
  EXPECT_EQ(texels(kernel({kCubic}, twice, twice)), 16);
  EXPECT_EQ(texels(kernel({kLinear, gaussian_halving(), {{0, 1}}}, half, half)), 36);
  EXPECT_EQ(texels(kernel({kLinear, {{-1, 1}, {0, 1}, {1, 1}}, {{0, 1}}}, any, same)), 4);
  EXPECT_EQ(texels(kernel(kPlus, same, same)), 4);
  EXPECT_EQ(texels(kernel(kPlus, half, half)), 12) << "math.md's footprint of the plus";
  EXPECT_EQ(texels(kernel(kPlus, any, any)), 12);
  EXPECT_EQ(texels(kernel({kLinear, {{0, 1}, {3, 0}}, {{0, 1}}}, same, same)), 1) << "weights of zero read nothing";
}

TEST(FilterAnchor, ADoublingHasTwoPhasesAndNoDivision) {
  const auto text = main_of(kernel({kLinear}, twice, twice));
  EXPECT_THAT(text, HasSubstr("& 1"));
  EXPECT_THAT(text, Not(HasSubstr("ag_phase(")));
  EXPECT_THAT(main_of(kernel({kLinear}, any, same)), HasSubstr("ag_phase(ag_pixel.x"));
}

TEST(FilterAnchor, RowsOfFreeTapsReadEachTexelOnce) {
  KernelDesc desc = kernel(kPlus, same, same);
  desc.config.rows = 4;
  EXPECT_EQ(texels(desc), 14) << "4 + 4 beside the rows, 6 above, in and below them";
  const auto shared = rows_shared(kPlus, same, 4);
  ASSERT_TRUE(shared);
  EXPECT_EQ(shared->together, 14);
  EXPECT_EQ(shared->apart, 16);
  EXPECT_EQ(shared->lines, 6);
  desc = kernel(kPlus, twice, twice);
  desc.config.rows = 4;
  EXPECT_LT(texels(desc), 4 * texels(kernel(kPlus, twice, twice)));
  EXPECT_FALSE(rows_shared(kPlus, any, 4)) << "weights differ from row to row";
}

TEST(FilterAnchor, RowsOfFreeTapsShareTexelsAndSumsWhereTheImageGrows) {
  // Taps at whole and at half texels: four columns hold all of them, whichever place a pixel has.
  Filter up;
  up.interpolation = kLinear;
  up.taps = {{-1, 0, 0.125},      {1, 0, 0.125},      {0, -1, 0.125},     {0, 1, 0.125},
             {-0.5, -0.5, 0.125}, {0.5, -0.5, 0.125}, {-0.5, 0.5, 0.125}, {0.5, 0.5, 0.125}};
  KernelDesc desc = kernel(up, twice, twice);
  desc.config.rows = 8;
  const std::string text = main_of(desc);
  EXPECT_EQ(count(text, "ag_texel0("), 7 * 4) << "columns of each line";
  // Of the rows that a line belongs to, those above and below it weigh it alike.
  EXPECT_LT(count(text, "ag_line = vec4(0.0)"), count(text, "+= ag_line")) << text;
}

TEST(FilterAnchor, CoordinatesAreClampedOnceAndOnlyWhereTheyCanLeave) {
  const auto text = main_of(kernel({kLinear}, half, half));
  EXPECT_EQ(count(text, "clamp("), 0);
  EXPECT_EQ(count(text, "min("), 0);
  EXPECT_EQ(count(main_of(kernel({kCubic}, any, any)), "clamp("), 8);
}

TEST(FilterAnchor, TheSamplerIsUsedOnlyWhereItSavesReads) {
  EXPECT_EQ(fetches(kernel({kLinear}, same, same, true)), 0);
  EXPECT_EQ(fetches(kernel({kLinear}, any, any, true)), 1);
  EXPECT_EQ(fetches(kernel({kLinear}, half, half, true)), 1);
  EXPECT_EQ(fetches(kernel({kCubic}, any, any, true)), 4);
  EXPECT_EQ(fetches(kernel({kNearest}, any, any, true)), 0);
  EXPECT_EQ(fetches(kernel({kLinear, gaussian_halving(), {{0, 1}}}, half, half, true)), 9);
  const Filter nine{
      kLinear, {{0, 1}}, {{-4, 66}, {-3, 220}, {-2, 495}, {-1, 792}, {0, 924}, {1, 792}, {2, 495}, {3, 220}, {4, 66}}};
  EXPECT_EQ(fetches(kernel(nine, same, same, true)), 5) << "neighbours in pairs";
  EXPECT_EQ(fetches(kernel(nine, same, same, false)), 0);
  EXPECT_EQ(fetches(kernel(kPlus, half, half, true)), 4);
}

TEST(FilterAnchor, MergedFetchesLieBetweenTheirTexels) {
  const Filter pair{kLinear, {{0, 1}, {1, 3}}, {{0, 1}}};
  EXPECT_THAT(main_of(kernel(pair, same, same, true)), HasSubstr("float(ag_pixel.x) + 1.25"));
  const Filter signs{kLinear, {{0, 1}, {1, -3}}, {{0, 1}}};
  EXPECT_EQ(fetches(kernel(signs, same, same, true)), 0) << "weights of two signs are no interpolation";
}

TEST(FilterAnchor, TheTextDoesNotDependOnSizes) {
  const auto a = assemble(kernel({kCubic}, any, any)), b = assemble(kernel({kCubic}, any, any));
  EXPECT_EQ(a->hash, b->hash);
  EXPECT_NE(a->hash, assemble(kernel({kCubic}, any, twice))->hash);
}

TEST(FilterAnchor, UnusableFiltersAreRefused) {
  const auto message = [](Filter filter, AxisRatio ratio = any) {
    const auto result = assemble(kernel(std::move(filter), ratio, ratio));
    if (result.ok()) return std::string("ok");
    EXPECT_EQ(result.error().kind, ErrorKind::script);
    return result.error().text();
  };
  EXPECT_THAT(message({kLinear, {}, {{0, 1}}}), HasSubstr("the filter has no taps"));
  EXPECT_THAT(message({kLinear, {{0, NAN}}, {{0, 1}}}), HasSubstr("finite weights"));
  EXPECT_THAT(message({kLinear, {{0, INFINITY}}, {{0, 1}}}), HasSubstr("finite weights"));
  EXPECT_THAT(message({kLinear, {{NAN, 1}}, {{0, 1}}}), HasSubstr("offsets of at most 65536"));
  EXPECT_THAT(message({kLinear, {{0, 1}}, {{1e9, 1}}}), HasSubstr("offsets of at most 65536"));
  EXPECT_THAT(message({kLinear, {{0, 1}}, {{0, 1}}, {{0, 0, 1}, {0, -INFINITY, 1}}}),
              HasSubstr("offsets of at most 65536"));
  Filter many{kLinear, {}, {{0, 1}}};
  for (int i = 0; i < 300; ++i) many.x.push_back({i * 1.0, 1});
  EXPECT_THAT(message(many), HasSubstr("the filter reads 301 texels; allowed: at most 256"));
  Filter free{kLinear};
  for (int i = 0; i < 300; ++i) free.taps.push_back({i * 2.0, i * 2.0, 1});
  EXPECT_THAT(message(free, half), HasSubstr("texels; allowed: at most 1024"));
  EXPECT_EQ(message({kLinear, {{-65536, 1e30}}, {{65536, -1e-30}}}), "ok");
}

TEST(FilterAnchor, AFilterAndASampleStageAreTwoAnchors) {
  ShaderFiles files;
  auto desc = kernel({kLinear}, any, any);
  desc.sample = files.stage("s", "vec4 sample_at(ivec2 p) { return vec4(0); }\n");
  const auto result = assemble(desc);
  ASSERT_FALSE(result.ok());
  EXPECT_THAT(result.error().message, HasSubstr("one anchor"));
}

/// Every kind of kernel is valid SPIR-V for Vulkan 1.1.
TEST(Spirv, EveryHeadWithAndWithoutStagesIsValid) {
  ShaderFiles files;
  const auto first = files.stage(
      "a", "uniform float t;\nuniform bool b;\nvec4 apply(vec4 c, vec4 high) { return b ? c * t : high; }\n");
  const auto second = files.stage("b",
                                  "uniform sampler2D lut;\nlayout(constant_id = 0) const int n = 3;\nvec4 apply(vec4 "
                                  "c) { for (int i = 0; i < n; ++i) c += fetch(lut, ivec2(i)); return c; }\n");
  const auto sample = files.stage("s",
                                  "uniform sampler2D d;\nvec4 sample_at(ivec2 p) { return sample_scaled(d, p, "
                                  "ivec2(1)) + fetch_linear(d, vec2(p)); }\n");
  std::vector<KernelDesc> anchors(1);
  anchors.emplace_back().sample = sample;
  for (const auto interpolation : {kNearest, kLinear, kCubic})
    for (const auto ratio_x : {any, same, half, twice})
      for (const auto ratio_y : {any, same, half, twice})
        for (const bool hardware : {false, true}) {
          anchors.push_back(kernel({interpolation, {{-1.25, 0.5}, {0, 0.5}}, {{0, 1}}}, ratio_x, ratio_y, hardware));
          if (ratio_x == ratio_y)
            anchors.push_back(
                kernel({interpolation, {{0, 1}}, {{0, 1}}, {{0.5, -1, 0.5}, {1, 0, 0.5}}}, ratio_x, ratio_y, hardware));
          if (ratio_x == ratio_y)
            anchors.push_back(
                kernel({interpolation, gaussian_halving(), gaussian_halving()}, ratio_x, ratio_y, hardware));
        }
  spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_1);
  std::string problems;
  tools.SetMessageConsumer([&](spv_message_level_t, const char*, const spv_position_t&, const char* message) {
    problems += std::string(message) + "\n";
  });
  KernelCompiler compiler{std::filesystem::path()};
  int valid = 0;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    auto desc = anchors[i];
    desc.target = i % 2 == 1 ? KernelTarget::float16 : KernelTarget::float32;
    if (i % 3 != 0) desc.stages.push_back(first);
    if (i % 3 == 2) desc.stages.push_back(second);
    const auto compiled = compiler.compile(desc);
    ASSERT_TRUE(compiled.ok()) << compiled.error().text();
    EXPECT_TRUE(tools.Validate(compiled->spirv)) << problems << assemble(desc)->glsl;
    ++valid;
  }
  EXPECT_EQ(valid, 2 + 3 * 2 * (16 + 4 + 4));
  EXPECT_EQ(problems, "");
}

}  // namespace
}  // namespace afterglow
