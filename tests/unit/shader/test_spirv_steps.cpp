// SPDX-License-Identifier: MIT
// Everything that is done to SPIR-V on CPU devices leaves the pixels of random shaders as they are, bit for bit. (That
// the modules are valid, of many more shaders: tests/fuzz/spirv.cpp.)
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <random>
#include <spirv-tools/libspirv.hpp>

#include "../../fuzz/random_shader.h"
#include "kernel_runner.h"
#include "shader_files.h"
#include "untouched.h"

namespace afterglow {
namespace {

TestImage waves(Size size) {
  TestImage out{size, std::vector<float>(static_cast<std::size_t>(size.area()) * 4)};
  for (std::size_t i = 0; i < out.rgba.size(); ++i) out.rgba[i] = static_cast<float>(i * 37 % 101) / 23.f;
  return out;
}

std::vector<std::byte> values(const CompiledKernel& kernel, std::int32_t n, float g) {
  std::vector<std::byte> out(kernel.block_size);
  const auto set = [&](const std::string& name, const auto& value) {
    for (const auto& param : kernel.params)
      if (param.name == name && param.offset != KernelParam::kUnread)
        std::memcpy(&out[param.offset], &value, sizeof value);
  };
  set("n", n);
  set("g", g);
  set("two", std::array<float, 2>{-g, 1.5f});
  set("four", std::array<float, 4>{0.25f, g, -2.f, 1.f});
  set("pair", std::array<std::int32_t, 2>{n - 3, 2});
  set("flag", std::int32_t{n == 5});
  // Columns and elements are as far apart as vec4 are.
  using Vector = std::array<float, 4>;
  set("turn", std::array<Vector, 3>{Vector{g, -1.f, 0.5f}, {0.125f, 2.f, g}, {-0.5f, 0.f, 1.f}});
  set("list", std::array<Vector, 5>{Vector{0.5f}, {g}, {-3.f}, {0.f}, {1.25f}});
  set("points", std::array<Vector, 3>{Vector{1.f, g}, {-2.f, 0.f}, {0.75f, 0.25f}});
  return out;
}

/// NaN is NaN, whatever its bits.
bool same(const TestImage& a, const TestImage& b) {
  for (std::size_t i = 0; i < a.rgba.size(); ++i)
    if (std::memcmp(&a.rgba[i], &b.rgba[i], 4) != 0 && !(a.rgba[i] != a.rgba[i] && b.rgba[i] != b.rgba[i]))
      return false;
  return true;
}

/// Straight code gives drivers more to reorder than loops do: a + b + b.
bool near(const TestImage& a, const TestImage& b) {
  const auto known = [](float v) { return v == v && std::abs(v) < 1e30f; };
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    const float x = a.rgba[i], y = b.rgba[i];
    if (known(x) != known(y) || (known(x) && std::abs(x - y) > 1e-4f * (1.f + std::abs(x)))) return false;
  }
  return true;
}

TEST(SpirvSteps, PixelsOfRandomShadersStay) {
  const TestImage image = waves({9, 8});
  std::mt19937 random(11);
  KernelCompiler compiler({});
  int guarded = 0;
  const int rounds = std::getenv("AFTERGLOW_LONG") != nullptr ? 1000 : 40;
  for (int round = 0; round < rounds; ++round) {
    std::vector<std::uint8_t> bytes(36);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    const std::string text = fuzz::RandomShader(bytes.data(), bytes.size()).text();
    const ShaderFiles files;
    KernelDesc desc;
    desc.sample = files.stage("test/random", text);
    desc.config.defeat_uniform_inlining = true;  // Mesa divides by zeros that it knows in its own way
    const auto as_it_is = compiler.compile(desc);
    ASSERT_TRUE(as_it_is) << as_it_is.error().text() << "\n" << text;
    const CompiledKernel plain = untouched(desc, *as_it_is);
    EXPECT_TRUE(spvtools::SpirvTools(SPV_ENV_VULKAN_1_1).Validate(as_it_is->spirv)) << text;
    desc.config.guard_loops = desc.config.flat_parameters = true;
    desc.config.rows = round % 4 == 3 ? 4 : 1;
    const auto changed = compiler.compile(desc);
    ASSERT_TRUE(changed) << changed.error().text() << "\n" << text;
    EXPECT_TRUE(spvtools::SpirvTools(SPV_ENV_VULKAN_1_1).Validate(changed->spirv)) << text;
    guarded += !changed->loops.empty();
    for (const int n : {0, 5}) {
      const TestImage want = runner().run(*as_it_is, {image}, image.size, values(*as_it_is, n, 0.75f));
      EXPECT_TRUE(near(runner().run(plain, {image}, image.size, values(plain, n, 0.75f)), want)) << text;
      const TestImage made = runner().run(*changed, {image}, image.size, values(*changed, n, 0.75f));
      EXPECT_TRUE(same(want, made)) << "n = " << n << ", rows " << desc.config.rows << "\n" << text;
    }
  }
  EXPECT_GT(guarded, 5);
  EXPECT_EQ(runner().validation_errors(), 0);
}

}  // namespace
}  // namespace afterglow
