// SPDX-License-Identifier: MIT
// Several rows an invocation: what the work on one pixel is taken apart into, and that every row gets the very bits
// that it gets alone.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstring>
#include <spirv-tools/libspirv.hpp>

#include "kernel_runner.h"
#include "shader/cpu/interleave.h"
#include "shader/spirv_module.h"
#include "shader_files.h"

namespace afterglow {
namespace {

// Straight, choosing, choosing within a choice, with helpers, precise, looping, returning early, by place, with loops
// of a few turns, one of which never begins, left early, of many turns, and with turns cut short.
constexpr const char* kStages[] = {
    "vec4 apply(vec4 color) { return color * 2.0 + 1.0; }",
    "vec4 apply(vec4 color, vec4 other) { return color.r > other.r ? sqrt(color) / (other + 0.5) : other - color; }",
    R"(float ramp(float x) { return x > 1.0 ? (x > 2.0 ? 2.0 / x : x * x) : exp2(-x); }
uniform float gain;
vec4 apply(vec4 color) {
  vec3 c = color.rgb;
  if (c.r > c.g) { c.b = ramp(c.r); c.g *= gain; } else { c.r = ramp(c.g); }
  if (c.b > 1.5) c *= 0.5;
  return vec4(ramp(c.r), ramp(c.g), ramp(c.b), color.a);
})",
    R"(vec4 apply(vec4 color) {
  precise vec4 sum = color * 1.1 + color.brga * 0.3 - color * color;
  return sum;
})",
    "vec4 apply(vec4 color) { for (int i = 0; i < int(color.r * 3.0); ++i) color.g += sin(color.b); return color; }",
    "vec4 apply(vec4 color) { if (color.r > 1.0) return color.bgra; return color * 0.5; }",
    "vec4 apply(vec4 color, ivec2 pixel) { return color + vec4(pixel, pixel.y * 3, 1); }",
    R"(float ring(int x, int y) { return exp2(-1.3 * float(x * x + y * y)); }
vec4 apply(vec4 color, ivec2 pixel) {
  vec4 sum = vec4(0.0);
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      vec4 other = x < 0 ? color.brga : sqrt(color + float(pixel.x + x));
      if (y > 0) other *= 0.7;
      sum += ring(x, y) * other;
    }
  return sum;
})",
    R"(const bool wide = false;
vec4 apply(vec4 color) {
  if (wide) for (int i = 0; i < int(color.r); ++i) color.g += sin(color.b);
  for (int i = 8; i > 0; i -= 2) color = color * 0.5 + float(i);
  return color;
})",
    "vec4 apply(vec4 color) { for (int i = 0; i < 9; ++i) { if (color.r < float(i)) break; color.g += 0.3 * color.b; } "
    "return color; }",
    "vec4 apply(vec4 color) { for (int i = 0; i < 99; ++i) color.g = color.g * 0.7 + 0.3 * color.b; return color; }",
    R"(vec4 apply(vec4 color) {
  for (int j = 0; j < 2; ++j) { for (int i = 0; i < 3; ++i) { if (i == 1) continue; color.g += 0.3 * color[i]; } color = color.gbra; }
  return color;
})",
    // Functions that write to a variable, where not every pixel comes.
    R"(vec4 apply(vec4 color, ivec2 pixel) {
  float whole = -1.0, part = 0.0;
  int power = -3;
  if (pixel.y % 3 == 0) part = modf(color.r * 7.0, whole);
  if (color.g > 1.0) part += frexp(color.b, power);
  for (int i = 0; i < 3; ++i) if (color[i] > 2.0) part += modf(color[i], whole) * float(i);
  return vec4(whole, part, float(power), color.a);
})",
};

// Calls stay where a function has several returns; this one loops.
constexpr const char* kLoopsInACall =
    "float f(float x) { for (int i = 0; i < 5; ++i) { if (x > float(i)) return x * 2.0; x += 0.1; } return x; }\n"
    "vec4 apply(vec4 color) { return color + f(color.r); }";

class Rows : public testing::TestWithParam<std::size_t> {};

TEST_P(Rows, EachHasTheBitsThatItHasAlone) {
  const ShaderFiles files;
  KernelDesc desc;
  desc.stages = {files.stage("test/stage", kStages[GetParam()])};
  KernelCompiler compiler{std::filesystem::path()};
  const auto alone = compiler.compile(desc);
  ASSERT_TRUE(alone) << alone.error().text();
  const float gain = 0.7f;
  std::vector<std::byte> block(16);
  std::memcpy(block.data(), &gain, sizeof gain);
  for (const Size size : {Size{1, 1}, Size{13, 9}, Size{33, 32}}) {
    std::vector<TestImage> images;
    for (std::size_t i = 0; i < alone->images.size(); ++i)
      images.push_back(random_texels(size, static_cast<unsigned>(i) + 1));
    const TestImage expected = runner().run(*alone, images, size, block);
    for (const int rows : {2, 4, 8}) {
      desc.config.rows = rows;
      const auto kernel = compiler.compile(desc);
      ASSERT_TRUE(kernel) << kernel.error().text();
      EXPECT_EQ(runner().run(*kernel, images, size, block).rgba, expected.rgba) << rows << " rows, " << size.width;
    }
  }
  EXPECT_EQ(runner().validation_errors(), 0);
}

INSTANTIATE_TEST_SUITE_P(All, Rows, testing::Range<std::size_t>(0, std::size(kStages)));

/// The module of a kernel with 8 rows and this stage.
CompiledKernel compiled(const char* stage) {
  const ShaderFiles files;
  KernelDesc desc;
  desc.stages = {files.stage("test/stage", stage)};
  desc.config.rows = 8;
  return KernelCompiler{std::filesystem::path()}.compile(desc).value();
}

std::ptrdiff_t count(const CompiledKernel& kernel, spv::Op op) {
  const auto module = parse(kernel.spirv);
  return std::ranges::count(module->code, op, &Instruction::op);
}

TEST(Rows, KnowWhereTheyAre) {
  const ShaderFiles files;
  KernelDesc desc;
  desc.stages = {files.stage("test/stage", "vec4 apply(vec4 color, ivec2 pixel) { return vec4(pixel, 0, 1); }")};
  for (const int rows : {1, 8}) {
    desc.config.rows = rows;
    const auto kernel = KernelCompiler{std::filesystem::path()}.compile(desc);
    ASSERT_TRUE(kernel) << kernel.error().text();
    const TestImage out = runner().run(*kernel, {random_texels({7, 11}, 1)}, {7, 11});
    for (int y = 0; y < 11; ++y)
      for (int x = 0; x < 7; ++x) {
        EXPECT_EQ(out.at(x, y)[0], static_cast<float>(x));
        EXPECT_EQ(out.at(x, y)[1], static_cast<float>(y));
      }
  }
}

TEST(Interleave, TakesBranchesThatChooseApart) {
  for (const std::size_t stage : {0, 1, 2, 3}) {
    const CompiledKernel kernel = compiled(kStages[stage]);
    EXPECT_EQ(count(kernel, spv::OpFunctionCall), 0) << stage;
    EXPECT_EQ(count(kernel, spv::OpBranchConditional), 0) << stage;
    EXPECT_TRUE(spvtools::SpirvTools(SPV_ENV_VULKAN_1_1).Validate(kernel.spirv)) << stage;
  }
}

TEST(Interleave, LeavesLoopsAsTheyAre) {
  const CompiledKernel kernel = compiled(kStages[4]);
  EXPECT_EQ(count(kernel, spv::OpLoopMerge), 1);
  EXPECT_GE(count(kernel, spv::OpFunctionCall), 8);
  EXPECT_FALSE(kernel.rows_pay);
}

TEST(Interleave, TakesLoopsOfAFewTurnsApart) {
  for (const std::size_t stage : {7, 8}) {
    const CompiledKernel kernel = compiled(kStages[stage]);
    EXPECT_TRUE(kernel.rows_pay) << stage;
    EXPECT_EQ(count(kernel, spv::OpLoopMerge), 0) << stage;
    EXPECT_EQ(count(kernel, spv::OpFunctionCall), 0) << stage;
    EXPECT_TRUE(spvtools::SpirvTools(SPV_ENV_VULKAN_1_1).Validate(kernel.spirv)) << stage;
  }
  for (const std::size_t stage : {9, 10}) EXPECT_FALSE(compiled(kStages[stage]).rows_pay) << stage;
  EXPECT_FALSE(compiled(kLoopsInACall).rows_pay);
}

/// 2047 calls: SPIRV-Tools would take seconds to make one function of them.
TEST(Interleave, LeavesManyCallsAsTheyAre) {
  std::string calls = "float f0(float x) { return sqrt(abs(x)); }\n";
  for (int i = 1; i <= 10; ++i)
    calls += fmt::format("float f{0}(float x) {{ return f{1}(x) + f{1}(x * 2.0); }}\n", i, i - 1);
  EXPECT_GE(
      count(compiled((calls + "vec4 apply(vec4 color) { return color + f10(color.r); }").c_str()), spv::OpFunctionCall),
      8);
  EXPECT_EQ(
      count(compiled((calls + "vec4 apply(vec4 color) { return color + f6(color.r); }").c_str()), spv::OpFunctionCall),
      0);
}

TEST(Interleave, RowsTakeTurns) {
  // Four square roots, one of each row, follow one another.
  const auto module = parse(compiled("vec4 apply(vec4 color) { return vec4(exp2(sqrt(color.r))); }").spirv);
  std::string order;
  for (const auto& instruction : module->code)
    if (instruction.op == spv::OpExtInst)
      order += instruction.words[4] == 31 ? 's' : instruction.words[4] == 29 ? 'e' : '-';
  EXPECT_THAT(order, testing::EndsWith("sssseeeesssseeee"));
}

TEST(Interleave, EveryCopyIsAsPreciseAsTheOriginal) {
  const auto module = parse(compiled(kStages[3]).spirv);
  std::ptrdiff_t decorated = 0, arithmetic = 0;
  for (const auto& instruction : module->code) {
    decorated += instruction.op == spv::OpDecorate && instruction.words[2] == spv::DecorationNoContraction;
    arithmetic += instruction.op == spv::OpFAdd || instruction.op == spv::OpFSub || instruction.op == spv::OpFMul ||
                  instruction.op == spv::OpVectorTimesScalar;
  }
  EXPECT_GE(arithmetic, 8 * 5);
  EXPECT_GE(decorated, arithmetic);
}

TEST(Interleave, LeavesWhatIsNoModuleAlone) {
  const std::vector<std::uint32_t> noise{1, 2, 3, 4, 5, 6};
  EXPECT_FALSE(interleave_rows(noise, 4));
  EXPECT_FALSE(interleave_rows({}, 4));
}

TEST(Rows, OutsideWhatADeviceHas) {
  KernelDesc desc;
  for (const int rows : {0, -1, 9}) {
    desc.config.rows = rows;
    EXPECT_FALSE(assemble(desc)) << rows;
  }
}

}  // namespace
}  // namespace afterglow
