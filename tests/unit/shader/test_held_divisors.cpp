// SPDX-License-Identifier: MIT
// What GLSL leaves to each device, or drivers make of constants, is one thing here.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <string>

#include "kernel_runner.h"
#include "shader_files.h"

namespace afterglow {
namespace {

using testing::ElementsAre;

/// Of a picture that is 0.5, 0.25, 2, 1 everywhere; the same alone and by rows.
std::array<float, 4> pixel_of(const std::string& shader) {
  const ShaderFiles files;
  KernelCompiler compiler({});
  std::array<float, 4> first{};
  for (const int rows : {1, 8}) {
    KernelDesc desc;
    desc.stages = {files.stage("test/divided", shader)};
    desc.config.rows = rows;
    const auto kernel = compiler.compile(desc);
    EXPECT_TRUE(kernel) << kernel.error().text();
    if (!kernel) return {};
    TestImage image{{5, 16}, {}};
    for (long long i = 0; i < image.size.area(); ++i) image.rgba.insert(image.rgba.end(), {0.5f, 0.25f, 2.f, 1.f});
    const TestImage result = runner().run(*kernel, {image}, image.size);
    std::array<float, 4> pixel{};
    std::copy_n(result.rgba.begin(), 4, pixel.begin());
    if (rows == 1) first = pixel;
    EXPECT_EQ(pixel, first);
  }
  EXPECT_EQ(runner().validation_errors(), 0);
  return first;
}

TEST(HeldDivisors, ByZeroANumberIsItselfAndNothingIsLeft) {
  const std::string numbers = "vec4 apply(vec4 color) { int zero = int(color.r), seven = int(color.b * 3.5);\n";
  EXPECT_THAT(pixel_of(numbers + "return vec4(seven / zero, seven % zero, uint(seven) / uint(zero), uint(seven) % "
                                 "uint(zero)); }"),
              ElementsAre(7, 0, 7, 0));
  EXPECT_THAT(pixel_of(numbers + "return vec4(ivec3(seven) / ivec3(zero, 2, seven - 5), -seven / zero); }"),
              ElementsAre(7, 3, 3, -7));
  EXPECT_THAT(pixel_of(numbers + "seven %= zero; return vec4(seven, uvec2(9, 10) % uvec2(zero, 4), 12 / 5); }"),
              ElementsAre(0, 0, 2, 2));
}

TEST(HeldDivisors, PackedConstantsAreThoseOfTheFormula) {
  EXPECT_THAT(pixel_of("vec4 apply(vec4 color) { uint more = uint(color.r);\n"
                       "return vec4(unpackHalf2x16(0xc0003800u), unpackHalf2x16(0xc0003800u + more)); }"),
              ElementsAre(0.5f, -2.f, 0.5f, -2.f));
  const std::string bytes = "return vec4(p & 255u, p >> 8 & 255u, p >> 16 & 255u, p >> 24); }";
  EXPECT_THAT(pixel_of("vec4 apply(vec4 color) { uint p = packSnorm4x8(vec4(-1.0, 1.0, 0.5, -0.5)); " + bytes),
              ElementsAre(0x81, 0x7f, 0x40, 0xc0));
  EXPECT_THAT(pixel_of("vec4 apply(vec4 color) { uint p = packSnorm4x8(vec4(-2.0, 9.0, color.r, -color.r)); " + bytes),
              ElementsAre(0x81, 0x7f, 0x40, 0xc0));
}

TEST(HeldDivisors, HalvesAreRoundedAlikeInConstants) {
  EXPECT_THAT(pixel_of("vec4 apply(vec4 color) { float zero = color.r - color.r;\n"
                       "return vec4(round(2.5), round(2.5 + zero), round(-1.5), round(vec2(0.5, -1.5) + zero).y); }"),
              ElementsAre(2, 2, -2, -2));
}

}  // namespace
}  // namespace afterglow
