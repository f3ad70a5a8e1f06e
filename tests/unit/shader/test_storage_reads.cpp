// SPDX-License-Identifier: MIT
// Images read as storage images: which inputs can be, what becomes of the author's reads, and that it is valid SPIR-V.
#include <gmock/gmock.h>

#include <spirv-tools/libspirv.hpp>

#include "shader/cpu/storage_reads.h"
#include "shader_files.h"

namespace afterglow {
namespace {

using testing::HasSubstr;
using testing::Not;

bool by_prelude(const std::string& text, const std::string& name = "depth") {
  return read_by_prelude_alone(tokenize(text, "test.glsl").value().tokens, name);
}

TEST(StorageReads, OnlyWhatThePreludeReadsAlone) {
  EXPECT_TRUE(by_prelude(
      "uniform sampler2D depth;\nvec4 sample_at(ivec2 p) { return fetch(depth, p) + fetch_linear(depth, vec2(p)); }"));
  EXPECT_TRUE(by_prelude("uniform sampler2D depth;\nint f() { return image_size(depth).x; }"));
  EXPECT_FALSE(by_prelude("uniform sampler2D depth;\nvec4 f(ivec2 p) { return texelFetch(depth, p, 0); }"));
  EXPECT_FALSE(by_prelude(
      "uniform sampler2D depth;\nvec4 g(sampler2D i) { return fetch(i, ivec2(0)); }\nvec4 f() { return g(depth); }"));
  EXPECT_FALSE(by_prelude("uniform sampler2D depth;\n#define READ(p) fetch(depth, p)\n"));
}

TEST(StorageReads, FunctionsLoseTheImageAndKeepTheirMeaning) {
  const std::string text = storage_reads("ag_r1_", "ag_s0_depth");
  EXPECT_THAT(text, HasSubstr("vec4 ag_r1_fetch(ivec2 pixel)"));
  EXPECT_THAT(text, HasSubstr("vec4 ag_r1_sample_scaled(ivec2 pixel, ivec2 texel_offset)"));
  EXPECT_THAT(text, HasSubstr("imageLoad(ag_s0_depth, pixel)"));
  EXPECT_THAT(text, Not(HasSubstr("sampler2D")));
  EXPECT_THAT(text, Not(HasSubstr("texelFetch")));
  EXPECT_THAT(text, Not(HasSubstr("(image")));
}

constexpr const char* kEdges = R"(uniform sampler2D picture;
uniform sampler2D depth;
vec4 sample_at(ivec2 pixel) {
  return fetch(picture, pixel + ivec2(image_size(picture).x, 0)) + sample_scaled(depth, pixel, ivec2(1)) + fetch_linear(picture,
    vec2(pixel)) * fetch(depth, ivec2(fetch(picture, pixel).xy));
}
)";

TEST(StorageReads, EachSlotGetsWhatWasWishedForIt) {
  const ShaderFiles files;
  KernelDesc desc;
  desc.sample = files.stage("test/edges", kEdges);
  desc.stages = {files.stage("test/mix", "vec4 apply(vec4 color, vec4 other) { return color + other; }")};
  desc.reads = {ImageRead::storage_rgba32f, ImageRead::sampled, ImageRead::storage_rgba16f};
  const auto assembled = assemble(desc);
  ASSERT_TRUE(assembled) << assembled.error().text();
  ASSERT_EQ(assembled->images.size(), 3u);
  EXPECT_EQ(assembled->images[0].read, ImageRead::storage_rgba32f);
  EXPECT_EQ(assembled->images[1].read, ImageRead::sampled);
  EXPECT_EQ(assembled->images[2].read, ImageRead::storage_rgba16f);
  EXPECT_THAT(assembled->glsl, HasSubstr("binding = 1, rgba32f) uniform readonly image2D ag_s0_picture"));
  EXPECT_THAT(assembled->glsl, HasSubstr("binding = 2) uniform sampler2D ag_s0_depth"));
  EXPECT_THAT(assembled->glsl, HasSubstr("binding = 3, rgba16f) uniform readonly image2D"));
  EXPECT_THAT(assembled->glsl, HasSubstr("ag_r1_fetch( pixel + ivec2(ag_r1_image_size().x, 0))"));
  EXPECT_THAT(assembled->glsl, HasSubstr("fetch(ag_s0_depth, ivec2(ag_r1_fetch( pixel).xy))"));
}

TEST(StorageReads, AnInputThatCannotBeStaysSampled) {
  const ShaderFiles files;
  KernelDesc desc;
  desc.sample = files.stage(
      "test/raw", "uniform sampler2D picture;\nvec4 sample_at(ivec2 p) { return texelFetch(picture, p, 0); }");
  desc.reads = {ImageRead::storage_rgba32f};
  const auto assembled = assemble(desc);
  ASSERT_TRUE(assembled) << assembled.error().text();
  EXPECT_EQ(assembled->images[0].read, ImageRead::sampled);
}

TEST(StorageReads, KernelsAreValidAndLinesStay) {
  const ShaderFiles files;
  KernelCompiler compiler({});
  const spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_1);
  for (const ImageRead read : {ImageRead::storage_rgba32f, ImageRead::storage_rgba16f, ImageRead::storage_r32f}) {
    KernelDesc sampled, filtered, own;
    sampled.sample = files.stage("test/edges", kEdges);
    sampled.reads = {read, read};
    filtered.filter = Filter{Interpolation::cubic_bspline};
    filtered.ratio_x = filtered.ratio_y = AxisRatio::twice;
    filtered.reads = {read};
    own.stages = {files.stage("test/mix", "vec4 apply(vec4 color, vec4 other) { return color + other; }")};
    own.reads = {read, read};
    for (const auto& desc : {sampled, filtered, own}) {
      const auto kernel = compiler.compile(desc);
      ASSERT_TRUE(kernel) << kernel.error().text();
      EXPECT_TRUE(tools.Validate(kernel->spirv));
    }
  }
  KernelDesc wrong;
  wrong.sample = files.stage(
      "test/wrong",
      "uniform sampler2D picture;\nvec4 sample_at(ivec2 p) {\n  vec4 c = fetch(picture,\n    p);\n  return d;\n}");
  wrong.reads = {ImageRead::storage_rgba32f};
  const auto failed = compiler.compile(wrong);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().line, 5);
}

}  // namespace
}  // namespace afterglow
