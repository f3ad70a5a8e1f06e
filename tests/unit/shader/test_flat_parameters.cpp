// SPDX-License-Identifier: MIT
// Parameters that come through the vertex shader: they arrive as the same bits, whatever they are, and both modules are
// valid.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>
#include <spirv-tools/libspirv.hpp>

#include "kernel_runner.h"
#include "shader/spirv_module.h"
#include "shader_files.h"

namespace afterglow {
namespace {

// What is shown are bits, in halves: numbers that are not finite, and small ones, would not come through.
constexpr const char* kBits = R"(uniform bool flag;
uniform float one;
uniform vec2 two;
uniform vec3 three;
uniform vec4 four;
uniform int count;
uniform ivec2 pair;
uint bits_of(int i) {
  uint bits[17] = uint[](uint(flag), floatBitsToUint(one), floatBitsToUint(two.x), floatBitsToUint(two.y),
    floatBitsToUint(three.x), floatBitsToUint(three.y), floatBitsToUint(three.z), floatBitsToUint(four.x),
    floatBitsToUint(four.y), floatBitsToUint(four.z), floatBitsToUint(four.w), uint(count), uint(pair.x), uint(pair.y),
    uint(target_size().x), uint(target_size().y), 77u);
  return bits[i];
}
vec4 sample_at(ivec2 pixel) {
  uint bits = bits_of(pixel.x);
  return vec4(float(bits & 0xffffu), float(bits >> 16u), three.y < 0.0 ? 1.0 : 0.0, 1.0);
}
)";

CompiledKernel compiled(const char* text, bool flat, int rows = 1) {
  const ShaderFiles files;
  KernelCompiler compiler({});
  KernelDesc desc;
  desc.sample = files.stage("test/bits", text);
  desc.config.flat_parameters = flat;
  desc.config.defeat_uniform_inlining = flat;
  desc.config.rows = rows;
  auto kernel = compiler.compile(desc);
  EXPECT_TRUE(kernel) << kernel.error().text();
  return *kernel;
}

std::vector<std::byte> block(const CompiledKernel& kernel) {
  std::vector<std::byte> out(kernel.block_size);
  const auto set = [&](const std::string& name, const auto& value) {
    for (const auto& param : kernel.params)
      if (param.name == name) std::memcpy(&out[param.offset], &value, sizeof value);
  };
  using Limits = std::numeric_limits<float>;
  set("flag", std::int32_t{1});
  set("one", -0.f);
  set("two", std::array<float, 2>{Limits::infinity(), Limits::denorm_min()});
  set("three", std::array<float, 3>{1e-40f, -3, Limits::max()});
  set("four", std::array<std::uint32_t, 4>{0x7fc12345u, 0xffc00001u, 1u, 0x80000003u});
  set("count", std::int32_t{5});
  set("pair", std::array<std::int32_t, 2>{-1, std::numeric_limits<std::int32_t>::min()});
  return out;
}

TEST(FlatParameters, EveryNumberArrivesAsItIs) {
  KernelRunner runner;
  const CompiledKernel plain = compiled(kBits, false);
  const Size size{17, 4};
  const TestImage want = runner.run(plain, {}, size, block(plain));
  EXPECT_EQ(want.rgba[4], 0.f);  // −0
  EXPECT_EQ(want.rgba[5], 0x8000.0p0f);
  EXPECT_EQ(want.rgba[14 * 4], 17.f);  // the target's width
  for (const int rows : {1, 4}) {
    const CompiledKernel flat = compiled(kBits, true, rows);
    ASSERT_TRUE(flat.flat_parameters);
    const TestImage made = runner.run(flat, {}, size, block(flat));
    for (std::size_t i = 0; i < want.rgba.size(); ++i) EXPECT_EQ(made.rgba[i], want.rgba[i]) << "number " << i;
    const auto modules = flat_parameters(flat.spirv, 16);
    ASSERT_TRUE(modules);
    EXPECT_TRUE(spvtools::SpirvTools(SPV_ENV_VULKAN_1_1).Validate(modules->vertex));
    EXPECT_TRUE(spvtools::SpirvTools(SPV_ENV_VULKAN_1_1).Validate(modules->fragment));
    EXPECT_FALSE(flat_parameters(flat.spirv, 4)) << "16 numbers, and one that is always 0";
  }
  EXPECT_EQ(runner.validation_errors(), 0);
}

// lavapipe compiles a function, in each process anew, for each number of inputs.
TEST(FlatParameters, FewAndManyOfThemComeInEquallyManyInputs) {
  const auto locations = [](const CompiledKernel& kernel) {
    const auto modules = flat_parameters(kernel.spirv, 31);
    EXPECT_TRUE(modules);
    std::size_t inputs = 0;
    const auto module = parse(modules->fragment);
    for (const auto& i : module->code)
      if (i.op == spv::OpDecorate && i.words[2] == spv::DecorationFlat) ++inputs;
    return inputs;
  };
  const char* one = "uniform float a;\nvec4 sample_at(ivec2 pixel) { return vec4(a); }\n";
  const char* ten = R"(uniform vec4 a; uniform vec4 unread; uniform vec3 b; uniform vec2 c; uniform float d;
vec4 sample_at(ivec2 pixel) { return a + vec4(b, d) + vec4(c, c); }
)";
  EXPECT_EQ(locations(compiled(one, true)), 3u);
  EXPECT_EQ(locations(compiled(ten, true)), 3u);
  EXPECT_EQ(locations(compiled(kBits, true)), 8u);
}

/// Whole matrices, columns and numbers of them, and elements of arrays, wherever they lie in the block.
TEST(FlatParameters, MatricesAndElementsArriveAsTheyAre) {
  constexpr const char* kText = R"(uniform float one;
uniform mat3 whole;
uniform mat2 part;
uniform vec2 pairs[3];
uniform float last[4];
vec4 sample_at(ivec2 pixel) {
  vec3 v = whole * vec3(float(pixel.x), 2.0, one);
  return vec4(v.xy + part[1] + pairs[2], v.z + part[0][1] + last[3], last[1] * pairs[1].y);
}
)";
  KernelRunner runner;
  const auto filled = [](const CompiledKernel& kernel) {
    std::vector<std::byte> bytes(kernel.block_size);
    for (std::size_t i = 0; 4 * i < bytes.size(); ++i) {
      const float number = 0.25f * static_cast<float>(i) - 3;
      std::memcpy(&bytes[4 * i], &number, 4);
    }
    return bytes;
  };
  const CompiledKernel plain = compiled(kText, false), flat = compiled(kText, true);
  EXPECT_EQ(plain.block_size, 16u + 3 * 16 + 2 * 16 + 3 * 16 + 4 * 16);
  ASSERT_TRUE(flat.flat_parameters);
  const TestImage want = runner.run(plain, {}, {9, 2}, filled(plain));
  EXPECT_NE(want.rgba[0], want.rgba[4]);
  EXPECT_EQ(runner.run(flat, {}, {9, 2}, filled(flat)).rgba, want.rgba);
  const auto modules = flat_parameters(flat.spirv, 16);
  ASSERT_TRUE(modules);
  EXPECT_TRUE(spvtools::SpirvTools(SPV_ENV_VULKAN_1_1).Validate(modules->vertex));
  EXPECT_TRUE(spvtools::SpirvTools(SPV_ENV_VULKAN_1_1).Validate(modules->fragment));
  // An element that the pixel chooses is read from the block.
  constexpr const char* kChosen = R"(uniform float of[4];
uniform float one;
vec4 sample_at(ivec2 pixel) { return vec4(of[pixel.x % 4] * one); }
)";
  const CompiledKernel chosen = compiled(kChosen, true), unchosen = compiled(kChosen, false);
  EXPECT_FALSE(flat_parameters(chosen.spirv, 16));
  EXPECT_EQ(runner.run(chosen, {}, {9, 2}, filled(chosen)).rgba, runner.run(unchosen, {}, {9, 2}, filled(chosen)).rgba);
  EXPECT_EQ(runner.validation_errors(), 0);
}

TEST(FlatParameters, WithoutParametersNothingIsDone) {
  const CompiledKernel none = compiled("vec4 sample_at(ivec2 pixel) { return vec4(pixel, 0.0, 1.0); }\n", true);
  EXPECT_FALSE(flat_parameters(none.spirv, 16));
  EXPECT_FALSE(flat_parameters({1, 2, 3}, 16));
  EXPECT_FALSE(flat_parameters({}, 16));
}

}  // namespace
}  // namespace afterglow
