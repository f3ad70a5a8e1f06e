// SPDX-License-Identifier: MIT
// What the compiler takes and devices need not: barriers that only some invocations come to, abilities that are off.
#include <gmock/gmock.h>

#include "shader_files.h"

namespace afterglow {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// "ok", or the error.
std::string said_of(const std::string& text) {
  ShaderFiles files;
  files.write("lib/wait.glsl", "void wait_here() { barrier(); }\n");
  const auto source = files.find("x", text);
  if (!source) return source.error().text();
  KernelCompiler compiler{std::filesystem::path()};
  const auto result = compiler.compile(one({*source, {}, {}}));
  return result.ok() ? "ok" : result.error().text();
}

struct Case {
  const char* body;
  const char* before = "";  ///< functions and variables
  const char* what = "barrier()";
};

std::string shader_of(const Case& c) {
  return std::string(
             "layout(local_size_x = 16, local_size_y = 8) in;\n#include \"lib/wait.glsl\"\nuniform sampler2D "
             "source;\nuniform float v;\n") +
         c.before + "\nvec4 compute_at(ivec2 pixel) {\nvec4 c = fetch(source, pixel);\n" + c.body +
         "\nreturn c * v;\n}\n";
}

class DivergentBarrier : public testing::TestWithParam<Case> {};
TEST_P(DivergentBarrier, IsToldWithItsLine) {
  EXPECT_THAT(said_of(shader_of(GetParam())),
              AllOf(HasSubstr("x.glsl:8: error: "), HasSubstr(GetParam().what), HasSubstr("some do not come here")))
      << GetParam().body;
}
INSTANTIATE_TEST_SUITE_P(
    Shaders, DivergentBarrier,
    testing::Values(
        Case{"if (c.r > 0.5) barrier();"}, Case{"if (pixel.x >= 100) return c; barrier();"},
        Case{"if (gl_LocalInvocationIndex < 3u) wait_here();", "", "'wait_here'"},
        Case{"if (c.r > 0.5) wait_twice();", "void wait_twice() { wait_here(); wait_here(); }", "'wait_twice'"},
        Case{"for (int i = 0; i < int(gl_LocalInvocationIndex); ++i) barrier();"},
        Case{"for (int i = 0; i < 5; ++i) { if (c.r > 0.1 * float(i)) break; barrier(); }"},
        Case{"for (int i = 0; i < 5; ++i) { if (c.r > 0.1 * float(i)) continue; barrier(); }"},
        Case{"int i = 0; do { barrier(); ++i; } while (i < int(gl_LocalInvocationIndex));"},
        Case{"int k = 0; while (k < 3) { if (gl_LocalInvocationID.x == 2u) { if (v > 0.5) return c; } ++k; } "
             "barrier();"},
        Case{"switch (int(c.r)) { case 0: c.r = 1.0; break; case 1: barrier(); break; default: break; }"},
        Case{"bool b = v > 1.0 && c.r > 0.2; if (b) barrier();"},
        Case{"int n = c.r > 0.5 ? 2 : 3; for (int i = 0; i < n; ++i) barrier();"},
        Case{"int n = 0; if (c.r > 0.5) n = 3; for (int i = 0; i < n; ++i) barrier();"},
        Case{"int n = bound(int(c.r)); for (int i = 0; i < n; ++i) barrier();",
             "int bound(int x) { if (x > 3) return 3; return x; }"},
        Case{"int n = 2; change(n, c.r); for (int i = 0; i < n; ++i) barrier();",
             "void change(inout int n, float x) { if (x > 0.5) n = 3; }"},
        Case{"set(c.r); for (int i = 0; i < count; ++i) barrier();",
             "int count = 1; void set(float x) { if (x > 0.5) count = 3; }"},
        Case{"float w; float f = modf(c.r * 5.0, w); for (int i = 0; i < int(w); ++i) barrier();"},
        Case{"box[gl_LocalInvocationIndex] = c.r; barrier(); if (box[gl_LocalInvocationID.x] > 0.5) wait_here();",
             "shared float box[128];", "'wait_here'"}));

class SharedBarrier : public testing::TestWithParam<Case> {};
TEST_P(SharedBarrier, IsTaken) { EXPECT_EQ(said_of(shader_of(GetParam())), "ok") << GetParam().body; }
INSTANTIATE_TEST_SUITE_P(
    Shaders, SharedBarrier,
    testing::Values(
        Case{"wait_here();"}, Case{"for (int i = 0; i < int(v); ++i) { c += float(i); barrier(); }"},
        Case{"if (v > 2.0) barrier();"}, Case{"if (fetch(source, ivec2(0)).r > 0.5) barrier();"},
        Case{"if (gl_WorkGroupID.x == 0u) barrier();"},
        Case{"for (int i = 0; i < 5; ++i) { if (c.r > 0.1 * float(i)) continue; c.g += 1.0; } barrier();"},
        Case{"for (int i = 0; i < 5; ++i) { if (c.r > 0.1 * float(i)) break; c.g += 1.0; } barrier();"},
        Case{"switch (int(c.r)) { case 0: c.r = 1.0; break; case 1: c.g = 2.0; break; default: break; } barrier();"},
        Case{"int i = 0; do { barrier(); ++i; } while (i < 4);"},
        Case{"float t = turn(c.r); for (int i = 0; i < bound(int(v)); ++i) barrier(); c.r = t;",
             "float turn(float x) { if (x > 0.5) return 1.0; return x; } int bound(int x) { return x > 3 ? 3 : x; }"},
        Case{"int n = 2; change(n, v); for (int i = 0; i < n; ++i) barrier(); int m = 2; change(m, c.r);",
             "void change(inout int n, float x) { if (x > 0.5) n = 3; }"},
        Case{"box[gl_LocalInvocationIndex] = c.r; barrier(); if (box[0] > 0.5) barrier();", "shared float box[128];"}));

TEST(Usable, WhatDevicesNeedNotHaveIsRefused) {
  const auto apply = [](const std::string& text) {
    return said_of("vec4 apply(vec4 c) {\n" + text + "\nreturn c;\n}\n");
  };
  EXPECT_THAT(apply("double d = double(c.r); c.r = float(d);"), HasSubstr("x.glsl:2: error: 'double' is not allowed"));
  EXPECT_THAT(apply("c.rg = vec2(dvec2(c.rg));"), HasSubstr("'dvec2' is not allowed"));
  const auto sample = [](const std::string& text) {
    return said_of("uniform sampler2D source;\nvec4 sample_at(ivec2 pixel) {\nvec2 at = vec2(pixel) / 8.0;\n" + text +
                   "\n}\n");
  };
  EXPECT_THAT(sample("return textureGatherOffset(source, at, ivec2(pixel.x & 1, 0), 0);"),
              AllOf(HasSubstr("x.glsl:4: error: "), HasSubstr("textureGatherOffset")));
  EXPECT_EQ(sample("return textureGatherOffset(source, at, ivec2(1, 0), 0);"), "ok");
  EXPECT_THAT(sample("return vec4(textureQueryLod(source, at), 0, 1);"), HasSubstr("'textureQueryLod' is not allowed"));
  EXPECT_EQ(sample("return texture(source, at) / float(textureSize(source, 0).x);"), "ok");
}

TEST(Usable, TextureAtWholeNumbersIsTold) {
  const auto sample = [](const std::string& text) {
    return said_of("uniform sampler2D source;\nuniform float v;\nvec4 sample_at(ivec2 pixel) {\n" + text + "\n}\n");
  };
  for (const char* call : {"texture(source, pixel)", "textureLod(source, pixel + 1, 0.0)",
                           "textureOffset(source, pixel, ivec2(1, 0))", "v * texture(source, ivec2(3, 4)).rgbr"})
    EXPECT_THAT(sample(std::string("vec4 c = fetch(source, pixel);\nreturn ") + call + ";"),
                AllOf(HasSubstr("x.glsl:5: error: texture takes a position from 0 to 1, not whole numbers"),
                      HasSubstr("fetch(image, pixel)")))
        << call;
  EXPECT_EQ(sample("return texture(source, vec2(pixel) / 8.0) + textureLod(source, vec2(0.5), 0.0);"), "ok");
}

TEST(Usable, WhatBeginnersWriteIsAnsweredWithWhatToWrite) {
  const auto sample = [](const std::string& text) {
    return said_of("uniform sampler2D source;\nuniform float v;\nvec4 sample_at(ivec2 pixel) {\n" + text + "\n}\n");
  };
  EXPECT_THAT(sample("return texture2D(source, vec2(pixel));"),
              AllOf(HasSubstr("x.glsl:4: error: "), HasSubstr("write fetch(image, texel)")));
  EXPECT_THAT(sample("return fetch(source, vec2(pixel));"), HasSubstr("it is fetch(sampler2D image, ivec2 pixel)"));
  EXPECT_THAT(sample("v = 2.0; return vec4(v);"),
              HasSubstr("x.glsl:4: error: a uniform cannot be written to; copy it into a variable"));
  EXPECT_THAT(said_of("vec4 apply(vec4 c) {\n  return c * 2.0\n}\n"),
              AllOf(HasSubstr("x.glsl:3: error: a ';' is missing before this"), testing::Not(HasSubstr("VEC4"))));
  EXPECT_THAT(said_of("vec4 apply(vec4 c) {\n  vec4 sample = c;\n  return sample; }\n"),
              HasSubstr("x.glsl:2: error: 'sample' is a word of GLSL; choose another name"));
  EXPECT_THAT(said_of("vec4 apply(vec4 c) { return c; }\nfloat f(float x);\nfloat g(float x) { return x; }\n"), "ok");
  EXPECT_THAT(
      said_of("float g(float x) { return x; }\nfloat f(float x);\nvec4 apply(vec4 c) { return vec4(f(c.r)); }\n"),
      HasSubstr("x.glsl:2: error: 'f' is declared here, but defined nowhere"));
}

}  // namespace
}  // namespace afterglow
