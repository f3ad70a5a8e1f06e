// SPDX-License-Identifier: MIT
// Parameters whose values the driver is not to know: the pixels stay, and the module is valid. (That it then compiles
// nothing again: FramesLeaveNothingBehind in tests/effects.)
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <spirv-tools/libspirv.hpp>

#include "kernel_runner.h"
#include "shader/cpu/defeat_uniform_inlining.h"
#include "shader_files.h"

namespace afterglow {
namespace {

constexpr const char* kEveryType = R"(uniform sampler2D image;
uniform bool flag;
uniform float gain;
uniform vec2 two;
uniform vec3 three;
uniform vec4 four;
uniform int count;
uniform ivec2 pair;
vec4 sample_at(ivec2 pixel) {
  vec4 sum = vec4(0.0);
  vec2 direction = vec2(1.0, 0.0);
  float weight = 0.5;
  for (int i = 0; i < count; ++i) {
    float t = (float(i) + 0.5) / float(count);
    direction = mat2(-0.8, -0.6, 0.6, -0.8) * direction;
    vec4 read = fetch(image, pixel + i * pair + ivec2(floor(direction * t * 9.0 + 0.5))) * gain;
    weight += t;
    sum.rgb += (t / weight) * smoothstep(t - 0.5, t + 0.5, abs(read.a)) * (read.rgb - sum.rgb);
  }
  if (flag) sum.rg *= two;
  if (pixel.x > target_size().x / 2) sum.rgb += three;
  return sum + four;
}
)";

/// What the block holds, by name.
struct Values {
  std::int32_t flag = 1, count = 5;
  float gain = 0.25f;
  std::array<float, 2> two{2, 3};
  std::array<float, 3> three{0.5f, -1, 7};
  std::array<float, 4> four{1e-3f, 1e3f, 0, -0.f};
  std::array<std::int32_t, 2> pair{-1, 2};
  std::vector<std::byte> block(const CompiledKernel& kernel) const {
    std::vector<std::byte> out(kernel.block_size);
    const auto set = [&](const std::string& name, const auto& value) {
      for (const auto& param : kernel.params)
        if (param.name == name) std::memcpy(&out[param.offset], &value, sizeof value);
    };
    set("flag", flag);
    set("count", count);
    set("gain", gain);
    set("two", two);
    set("three", three);
    set("four", four);
    set("pair", pair);
    return out;
  }
};

TestImage ramp(Size size) {
  TestImage out{size, std::vector<float>(static_cast<std::size_t>(size.area()) * 4)};
  for (std::size_t i = 0; i < out.rgba.size(); ++i) out.rgba[i] = static_cast<float>(i % 97) / 7.f;
  return out;
}

CompiledKernel compiled(bool hide, int rows = 1) {
  const ShaderFiles files;
  KernelCompiler compiler({});
  KernelDesc desc;
  desc.sample = files.stage("test/types", kEveryType);
  desc.config.defeat_uniform_inlining = hide;
  desc.config.rows = rows;
  auto kernel = compiler.compile(desc);
  EXPECT_TRUE(kernel) << kernel.error().text();
  return *kernel;
}

TEST(DefeatUniformInlining, PixelsAreTheSameBits) {
  KernelRunner runner;
  const TestImage image = ramp({37, 21});
  const CompiledKernel plain = compiled(false);
  for (const int rows : {1, 4}) {
    const CompiledKernel hidden = compiled(true, rows);
    EXPECT_NE(hidden.hash, plain.hash);
    EXPECT_TRUE(spvtools::SpirvTools(SPV_ENV_VULKAN_1_1).Validate(hidden.spirv));
    for (const int flag : {0, 1}) {
      const Values values{.flag = flag};
      const TestImage want = runner.run(plain, {image}, image.size, values.block(plain));
      const TestImage made = runner.run(hidden, {image}, image.size, values.block(hidden));
      EXPECT_EQ(std::memcmp(want.rgba.data(), made.rgba.data(), want.rgba.size() * sizeof(float)), 0) << rows;
    }
  }
  EXPECT_EQ(runner.validation_errors(), 0);
}

TEST(DefeatUniformInlining, WhatIsNoModuleStays) {
  const std::vector<std::uint32_t> noise{1, 2, 3};
  EXPECT_EQ(defeat_uniform_inlining(noise), noise);
  EXPECT_EQ(defeat_uniform_inlining({}), std::vector<std::uint32_t>{});
}

}  // namespace
}  // namespace afterglow
