// SPDX-License-Identifier: MIT
// Several rows of a sample shader an invocation: what neighbours both read is read once, and every row gets the very
// bits that it gets alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <spirv-tools/libspirv.hpp>

#include "kernel_runner.h"
#include "shader/cpu/merge_equal.h"
#include "shader/spirv_module.h"
#include "shader_files.h"

namespace afterglow {
namespace {

struct Neighbours {
  const char* shader;
  std::ptrdiff_t reads;  ///< of eight rows, that are left
  bool shares;
};

const Neighbours kNeighbours[] = {
    // A column of three: ten texels for eight rows.
    {"uniform sampler2D source;\n"
     "vec4 sample_at(ivec2 p) { return fetch(source, p) + fetch(source, p + ivec2(0, 1)) - fetch(source, p - ivec2(0, "
     "1)); }",
     10, true},
    // Offsets that are made of constants, in a function with an early end, of two images.
    {R"(layout(constant_id = 0) const int apart = 2;
uniform sampler2D source;
uniform sampler2D other;
uniform float gain;
vec4 along(ivec2 p, ivec2 way) {
  if (apart == 0) return vec4(0.0);
  return fetch(source, p - way) * 0.5 + fetch(source, p + 2 * way) * gain;
}
vec4 sample_at(ivec2 p) { return along(p, ivec2(0, apart)) + along(p, -ivec2(0, apart)) + fetch(other, p + ivec2(apart, 0)); })",
     8 + 4 + 4 + 8, true},
    // In a row nothing is shared.
    {"uniform sampler2D source;\nvec4 sample_at(ivec2 p) { return fetch(source, p) + fetch(source, p + ivec2(1, 0)); }",
     16, false},
    // Nor where pixels decide for themselves.
    {R"(uniform sampler2D source;
vec4 sample_at(ivec2 p) {
  int step = int(fetch(source, p).r);
  return fetch(source, p + ivec2(0, step)) - fetch(source, p - ivec2(step, step));
})",
     24, false},
    // What is precise stays so.
    {R"(uniform sampler2D source;
vec4 sample_at(ivec2 p) {
  vec4 a = fetch(source, p), b = fetch(source, p + ivec2(0, 1));
  precise vec4 sum = a * 1.1 + b * b;
  return sum + (a * 1.1 + b * b);
})",
     9, true},
};

std::ptrdiff_t reads_of(const CompiledKernel& kernel) {
  const auto module = parse(kernel.spirv);
  return std::ranges::count_if(
      module->code, [](const Instruction& i) { return i.op == spv::OpImageRead || i.op == spv::OpImageFetch; });
}

class SharedRows : public testing::TestWithParam<std::size_t> {};

TEST_P(SharedRows, EachHasTheBitsThatItHasAlone) {
  const Neighbours& tried = kNeighbours[GetParam()];
  const ShaderFiles files;
  KernelDesc desc;
  desc.sample = files.stage("test/sample", tried.shader);
  desc.stages = {
      files.stage("test/stage", "vec4 apply(vec4 color, ivec2 pixel) { return color + vec4(pixel, 0, 1); }")};
  KernelCompiler compiler{std::filesystem::path()};
  const float gain = 0.7f;
  std::vector<std::byte> block(16);
  std::memcpy(block.data(), &gain, sizeof gain);
  const auto alone = compiler.compile(desc);
  ASSERT_TRUE(alone) << alone.error().text();
  for (const Size size : {Size{1, 1}, Size{2, 3}, Size{13, 9}, Size{33, 32}}) {
    std::vector<TestImage> images;
    for (std::size_t i = 0; i < alone->images.size(); ++i)
      images.push_back(random_texels(size, static_cast<unsigned>(i) + 1));
    const TestImage expected = runner().run(*alone, images, size, block);
    for (const int rows : {2, 4, 8}) {
      desc.config.rows = rows;
      const auto kernel = compiler.compile(desc);
      ASSERT_TRUE(kernel) << kernel.error().text();
      EXPECT_TRUE(spvtools::SpirvTools(SPV_ENV_VULKAN_1_1).Validate(kernel->spirv)) << rows;
      EXPECT_EQ(runner().run(*kernel, images, size, block).rgba, expected.rgba) << rows << " rows, " << size.width;
      if (rows != 8) continue;
      EXPECT_EQ(kernel->rows_pay, tried.shares);
      EXPECT_EQ(reads_of(*kernel), tried.reads);
    }
  }
  EXPECT_EQ(runner().validation_errors(), 0);
}

INSTANTIATE_TEST_SUITE_P(All, SharedRows, testing::Range<std::size_t>(0, std::size(kNeighbours)));

// Of lavapipe's pixels it cannot be seen: it contracts nothing. Other drivers may.
TEST(MergeEqual, WhatIsPreciseIsNotMergedWithWhatIsNot) {
  const ShaderFiles files;
  KernelDesc desc;
  desc.sample = files.stage("test/sample", kNeighbours[4].shader);
  desc.config.rows = 8;
  const auto kernel = KernelCompiler{std::filesystem::path()}.compile(desc);
  ASSERT_TRUE(kernel) << kernel.error().text();
  const auto module = parse(kernel->spirv);
  EXPECT_EQ(std::ranges::count(module->code, spv::OpVectorTimesScalar, &Instruction::op), 16);  // a * 1.1
}

TEST(MergeEqual, LeavesWhatIsNoModuleAlone) {
  const std::vector<std::uint32_t> noise{1, 2, 3, 4, 5, 6};
  EXPECT_EQ(merge_equal(noise).spirv, noise);
  EXPECT_EQ(merge_equal({}).spirv, std::vector<std::uint32_t>{});
}

}  // namespace
}  // namespace afterglow
