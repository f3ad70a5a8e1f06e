// SPDX-License-Identifier: MIT
// Loops that step through arrays become straight code, and pixels keep their bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <spirv-tools/libspirv.hpp>

#include "kernel_runner.h"
#include "shader/spirv_module.h"
#include "shader_files.h"
#include "untouched.h"

namespace afterglow {
namespace {

std::ptrdiff_t loops_in(const Words& spirv) {
  const auto module = parse(spirv);
  return module ? std::ranges::count(module->code, spv::OpLoopMerge, &Instruction::op) : -1;
}

/// Compiles a body of `vec4 sample_at(ivec2 p)`, holds its pixels to those of the untouched kernel, and returns how
/// many loops are left of it.
std::ptrdiff_t loops_left(const std::string& body, const std::string& before = "") {
  const ShaderFiles files;
  KernelCompiler compiler({});
  KernelDesc desc;
  desc.sample =
      files.stage("test/arrays", "uniform sampler2D source;\n" + before + "vec4 sample_at(ivec2 p) {\n" + body + "}\n");
  const auto made = compiler.compile(desc);
  if (!made) {
    ADD_FAILURE() << made.error().text();
    return -1;
  }
  EXPECT_TRUE(spvtools::SpirvTools(SPV_ENV_VULKAN_1_1).Validate(made->spirv)) << body;
  const CompiledKernel plain = untouched(desc, *made);
  EXPECT_GT(loops_in(plain.spirv), 0) << body;
  const TestImage image = random_texels({13, 9}, 5);
  const TestImage want = runner().run(plain, {image}, image.size);
  EXPECT_EQ(std::memcmp(want.rgba.data(), runner().run(*made, {image}, image.size).rgba.data(), want.rgba.size() * 4),
            0)
      << body;
  // The same with what CPU devices get on top of it: guards, and rows that share what they read.
  desc.config.guard_loops = desc.config.defeat_uniform_inlining = true;
  desc.config.rows = 4;
  const auto rows = compiler.compile(desc);
  EXPECT_TRUE(rows) << body;
  if (rows) {
    EXPECT_TRUE(spvtools::SpirvTools(SPV_ENV_VULKAN_1_1).Validate(rows->spirv)) << body;
    const TestImage by_rows = runner().run(*rows, {image}, image.size);
    EXPECT_EQ(std::memcmp(want.rgba.data(), by_rows.rgba.data(), want.rgba.size() * 4), 0) << body;
  }
  EXPECT_EQ(runner().validation_errors(), 0);
  return loops_in(made->spirv);
}

const char* const kNine =
    "  vec3 v[9];\n  int n = 0;\n  for (int y = -1; y <= 1; ++y)\n    for (int x = -1; x <= 1; ++x)"
    " v[n++] = fetch(source, p + ivec2(x, y)).rgb;\n";

TEST(UnrollArrays, ASortBecomesStraight) {
  EXPECT_EQ(loops_left(std::string(kNine) +
                       "  for (int i = 0; i < 5; ++i)\n    for (int j = i + 1; j < 9; ++j) {\n"
                       "      vec3 lo = min(v[i], v[j]);\n      v[j] = max(v[i], v[j]);\n      v[i] = lo;\n    }\n"
                       "  return vec4(v[4], 1.0);\n"),
            0);
}

TEST(UnrollArrays, WeightsOfEveryShapeAreStepsOfNumbers) {
  const std::string weights = "const float w[5] = float[](0.1, 0.2, 0.4, 0.2, 0.1);\n";
  EXPECT_EQ(
      loops_left(
          "  vec4 c = vec4(0.0);\n  for (int i = -2; i <= 2; ++i) c += w[i + 2] * fetch(source, p + ivec2(i, 0));\n"
          "  return c;\n",
          weights),
      0);
  EXPECT_EQ(loops_left("  vec4 c = vec4(0.0);\n  for (int i = 4; i >= 0; i -= 2) c += w[abs(i - 4)] * fetch(source, p "
                       "+ ivec2(i, 0));\n"
                       "  return c;\n",
                       weights),
            0);
  EXPECT_EQ(
      loops_left(
          "  vec4 c = vec4(0.0);\n  for (int i = -2; i <= 2; ++i) {\n    int k = i < 0 && i > -9 ? -i : i;\n"
          "    if (k == 2) k = 1; else k = 4;\n    c += w[k] * fetch(source, p + ivec2(0, i));\n  }\n  return c;\n",
          weights),
      0);
  EXPECT_EQ(
      loops_left("  vec4 c = fetch(source, p);\n  for (int i = 0; i < 3; ++i) c[i] = c[i] * c[2 - i] + float(i);\n"
                 "  return c;\n"),
      0);
  EXPECT_EQ(loops_left("  mat3 m = mat3(1.0);\n  vec4 c = fetch(source, p);\n"
                       "  for (int i = 0; i < 3; ++i) for (int j = 0; j < 3; ++j) m[i][j] += c.x * float(i * 3 + j);\n"
                       "  return vec4(m * c.rgb, 1.0);\n"),
            0);
}

TEST(UnrollArrays, TurnsMayEndEarly) {
  EXPECT_EQ(loops_left(std::string(kNine) +
                       "  vec3 sum = vec3(0.0);\n  for (int i = 0; i < 9; ++i) {\n    if (i == 4) continue;\n"
                       "    sum += abs(v[i] - v[4]);\n  }\n  return vec4(sum, 1.0);\n"),
            0);
  EXPECT_EQ(
      loops_left(
          std::string(kNine) +
          "  vec3 sum = vec3(0.0);\n  for (int i = 0; i < 9; ++i) {\n    if (v[i].x > 1.0) {\n      sum.x += 1.0;\n"
          "      if (v[i].y > 2.0) continue;\n    }\n    sum += v[i];\n  }\n  return vec4(sum, 1.0);\n"),
      0);
  EXPECT_EQ(loops_left(std::string(kNine) +
                       "  for (int i = 0; i < 5; ++i)\n    for (int j = 0; j < 9; ++j) {\n      if (j <= i) continue;\n"
                       "      vec3 lo = min(v[i], v[j]);\n      v[j] = max(v[i], v[j]);\n      v[i] = lo;\n    }\n"
                       "  return vec4(v[4], 1.0);\n"),
            0);
}

/// By the number of a turn one side of `&&` and `||` is known.
TEST(UnrollArrays, ConditionsOfWhichATurnKnowsASide) {
  const std::string fill = "  vec4 v = fetch(source, p);\n  float w[5] = float[](v.x, v.y, v.z, v.w, 1.0);\n";
  for (const char* peak : {"i > 0 && w[i] > w[i - 1]", "i == 0 || w[i] > w[i - 1]", "w[i] > 1.0 && i > 2",
                           "i > 0 && (i == 4 || w[i] > w[i - 1])", "(i > 0 && i < 4) && w[i] > w[i + 1]"})
    EXPECT_EQ(loops_left(fill + "  vec3 sum = vec3(0.0);\n  for (int i = 0; i < 5; ++i) if (" + peak +
                         ") sum += w[i];\n  return vec4(sum, 1.0);\n"),
              0)
        << peak;
  EXPECT_EQ(loops_left(fill + "  const bool debug = false;\n  float sum = 0.0;\n  if (debug && w[1] > 0.3) sum = 1.0;\n"
                              "  for (int i = 0; i < 3; ++i) sum += w[i];\n  return vec4(sum);\n"),
            0);
}

TEST(UnrollArrays, PreciseAndValuesThatAreMissingHoldInEachTurn) {
  EXPECT_EQ(loops_left(std::string(kNine) +
                       "  precise vec3 sum = vec3(0.0);\n  for (int i = 0; i < 9; ++i) {\n    float w;\n    int k;\n"
                       "    if (i > 3) { w = 0.5; k = i; }\n    sum += v[i] * w + vec3(k);\n    w = 9.0;\n  }\n"
                       "  return vec4(sum, 1.0);\n"),
            0);
}

TEST(UnrollArrays, FunctionsAndCountersBehindTheLoop) {
  EXPECT_EQ(loops_left("  float a[4];\n  int i;\n  for (i = 0; i < 4; ++i) a[i] = float(i) * fetch(source, p).x;\n"
                       "  return vec4(total(a), float(i), a[3], 1.0);\n",
                       "float total(float a[4]) {\n  float sum = 0.0;\n  for (int i = 0; i < 4; ++i) sum += a[i];\n"
                       "  return sum;\n}\n"),
            0);
}

/// Each loop alone is light; all copies together kept the compiler for minutes.
TEST(UnrollArrays, NestsOfManyTurnsStay) {
  EXPECT_EQ(loops_left("  float a[64];\n  for (int i = 0; i < 64; ++i) a[i] = fetch(source, p).r;\n"
                       "  for (int i = 0; i < 64; ++i) for (int j = 0; j < 64; ++j)\n"
                       "    for (int k = 0; k < 5; ++k) a[i] += a[j] * a[k] * 1e-3;\n  return vec4(a[5]);\n"),
            3);
}

TEST(UnrollArrays, OtherLoopsStay) {
  const std::string behind = "  return vec4(sum, 1.0);\n", sum = "  vec3 sum = vec3(0.0);\n";
  // Left by what is found.
  EXPECT_EQ(
      loops_left(std::string(kNine) + sum +
                 "  for (int i = 0; i < 9; ++i) {\n    if (v[i].x > 2.0) break;\n    sum += v[i];\n  }\n" + behind),
      1);
  // Nobody knows which element: a histogram.
  EXPECT_EQ(loops_left("  float bins[8];\n  for (int i = 0; i < 8; ++i) bins[i] = 0.0;\n" + sum +
                       "  for (int i = 0; i < 9; ++i) bins[int(fetch(source, p + i).x * 2.5) & 7] += 1.0;\n"
                       "  sum.x = bins[3];\n" +
                       behind),
            1);
  // Another loop within it, or within what it calls.
  const std::string count = "int count(int x) {\n  int n = 0;\n  while (n < x) n += 2;\n  return n;\n}\n";
  EXPECT_EQ(loops_left(std::string(kNine) + sum +
                       "  for (int i = 0; i < 9; ++i) for (int k = 0; k < p.x; ++k) sum += v[i];\n" + behind),
            2);
  EXPECT_EQ(
      loops_left(std::string(kNine) + sum + "  for (int i = 0; i < 9; ++i) sum += v[i] * float(count(p.x));\n" + behind,
                 count),
      2);
  // No array.
  EXPECT_EQ(loops_left(sum + "  for (int i = 0; i < 9; ++i) sum += fetch(source, p + i).rgb;\n" + behind), 1);
  // Memory is nothing beside so much work.
  EXPECT_EQ(
      loops_left(
          "  float w[4] = float[](fetch(source, p).x, 0.2, 0.3, 0.1);\n" + sum +
          "  for (int i = 0; i < 4; ++i) sum += w[i] * sin(cos(sin(cos(sin(cos(sin(cos(sin(sum + float(i))))))))));\n" +
          behind),
      1);
}

TEST(UnrollArrays, TapsOfFiltersStay) {
  Filter filter;
  filter.x.clear();
  for (int i = 0; i < 12; ++i) filter.x.push_back({i - 6.0, 1.0 / 12});
  filter.y = filter.x;
  KernelDesc desc;
  desc.filter = filter;
  const auto made = KernelCompiler({}).compile(desc);
  ASSERT_TRUE(made) << made.error().text();
  EXPECT_EQ(loops_in(made->spirv), 1);
}

}  // namespace
}  // namespace afterglow
