// SPDX-License-Identifier: MIT
// What a shader declares, and every message about what it must not.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "shader/scan.h"

namespace afterglow {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kOwnPixel = "vec4 apply(vec4 color) { return color; }\n";

ShaderScan scanned(const std::string& text) {
  static std::vector<std::unique_ptr<std::string>> keep;  // tokens are views of the text
  keep.push_back(std::make_unique<std::string>(text));
  auto result = scan(*keep.back(), "f.glsl", ScanAs::stage);
  if (!result) {
    ADD_FAILURE() << result.error().text();
    return {};
  }
  return std::move(result).value();
}

std::vector<std::string> names(const ShaderScan& scan) {
  std::vector<std::string> out;
  for (const auto& name : scan.names) out.push_back(name.name);
  return out;
}

TEST(Scan, RecordsThatGrowAreRefused) {
  const auto chain = [](int deep, const std::string& before, const std::string& behind) {
    std::string text = before + "struct S0 { float a; };\n";
    for (int i = 1; i < deep; ++i) text += fmt::format("struct S{} {{ S{} a, b; }};\n", i, i - 1);
    return text + behind;
  };
  const std::string end = "vec4 apply(vec4 c) { return c; }\n";
  EXPECT_TRUE(scan(chain(11, "", end), "a.glsl", ScanAs::stage)) << "1024 members";
  const auto grown = scan(chain(40, "", end), "a.glsl", ScanAs::stage);
  ASSERT_FALSE(grown);
  EXPECT_EQ(grown.error().text(),
            "a.glsl:12: error: 'S11' has more than 1024 members, with those of the records that it is made of");
  const auto local = scan(chain(40, "vec4 apply(vec4 c) {\n", "S39 s; return c; }\n"), "a.glsl", ScanAs::stage);
  ASSERT_FALSE(local);
  EXPECT_EQ(local.error().line, 13);
}

TEST(Scan, WholeNumbersOfEveryNotation) {
  const auto value = [](const std::string& literal) {
    return scanned("layout(constant_id = 0) const int n = " + literal + ";\nvec4 apply(vec4 c) { return c; }\n")
        .interface.params.at(0)
        .default_value;
  };
  EXPECT_EQ(value("16"), 16);
  EXPECT_EQ(value("0x1F"), 31);
  EXPECT_EQ(value("-0X10"), -16);
  EXPECT_EQ(value("010"), 8);
  EXPECT_EQ(value("0"), 0);
}

TEST(Scan, PixelShaderWithInputsAndParameters) {
  const auto scan = scanned(R"(// uniform float not_this;
/* uniform float
   nor_this; */
uniform float threshold;
uniform
  vec3
  tint;
uniform highp ivec2 a, b;
uniform sampler2D mask;
layout(constant_id = 3) const bool fade = true;
layout ( constant_id=4 ) const int count = -2;
layout(constant_id = 5) const float gain = 1.5e-1f;
vec4 apply(const in vec4 color, vec4 high,
           vec4 low) { uniform_like(threshold); return color; }
)");
  EXPECT_EQ(scan.interface.kind, PassKind::pixel);
  const auto& params = scan.interface.params;
  ASSERT_EQ(params.size(), 7u);
  EXPECT_EQ(params[0].name, "threshold");
  EXPECT_EQ(params[0].line, 4);
  EXPECT_FALSE(params[0].specialised);
  EXPECT_EQ(params[1].name, "tint");
  EXPECT_EQ(params[1].type, ParamType::float3);
  EXPECT_EQ(params[1].line, 7);
  EXPECT_EQ(params[2].name, "a");
  EXPECT_EQ(params[3].name, "b");
  EXPECT_EQ(params[3].type, ParamType::int2);
  EXPECT_EQ(params[4].name, "fade");
  EXPECT_TRUE(params[4].specialised);
  EXPECT_EQ(params[4].type, ParamType::bool1);
  EXPECT_EQ(params[4].default_value, 1);
  EXPECT_EQ(params[5].default_value, -2);
  EXPECT_EQ(params[5].type, ParamType::int1);
  EXPECT_EQ(params[6].default_value, 0.15);
  EXPECT_EQ(params[6].line, 12);
  const auto& inputs = scan.interface.inputs;
  ASSERT_EQ(inputs.size(), 3u);
  EXPECT_EQ(inputs[0].name, "mask");
  EXPECT_FALSE(inputs[0].pixelwise);
  EXPECT_EQ(inputs[1].name, "high");
  EXPECT_TRUE(inputs[1].pixelwise);
  EXPECT_EQ(inputs[1].line, 13);
  EXPECT_EQ(inputs[2].name, "low");
  EXPECT_EQ(inputs[2].line, 14);
}

TEST(Scan, SampleShader) {
  const auto scan =
      scanned("uniform sampler2D source;\r\nvec4 sample_at(ivec2 pixel)\r\n{ return fetch(source, pixel); }");
  EXPECT_EQ(scan.interface.kind, PassKind::sample);
  ASSERT_EQ(scan.interface.inputs.size(), 1u);
  EXPECT_EQ(scan.interface.inputs[0].name, "source");
}

TEST(Scan, SampleShaderThatTellsWhereItIsDone) {
  const std::string entry = "vec4 sample_at(ivec2 pixel) { return vec4(0.0); }\n";
  EXPECT_FALSE(scanned(entry).interface.done);
  EXPECT_FALSE(scanned("bool done_at(ivec2 pixel, out vec4 color);\n" + entry).interface.done) << "a prototype alone";
  EXPECT_TRUE(
      scanned("bool done_at(ivec2 p, out vec4 c) {\n  c = vec4(1.0);\n  return true;\n}\n" + entry).interface.done);
}

TEST(Scan, NamesAtFileScopeAndNoOthers) {
  const auto scan = scanned(R"(#include "lib/color.glsl"
#define HALF 0.5
#define SQUARE(x) ((x) * (x))
precision highp float;
struct Ray { vec3 from, to[2]; };
struct { float q; } anonymous;
const float kTable[3] = float[](1.0, 2.0, 3.0), kOther = 4.0;
float state = 1.0;
float helper(float inner);
float helper(float inner) { float local = inner; return local; }
vec4 apply(vec4 color) { return color * helper(HALF); }
)");
  EXPECT_THAT(names(scan),
              ElementsAre("HALF", "SQUARE", "Ray", "anonymous", "kTable", "kOther", "state", "helper", "apply"));
  EXPECT_TRUE(scan.names[0].macro);
  EXPECT_TRUE(scan.names[1].macro);
  EXPECT_FALSE(scan.names[2].macro);
  ASSERT_EQ(scan.includes.size(), 1u);
  EXPECT_EQ(scan.includes[0].name, "lib/color.glsl");
  EXPECT_EQ(scan.includes[0].line, 1);
}

TEST(Scan, MacrosOfQualifiersAreReadAsWhatTheyStandFor) {
  const auto scan = scanned(R"(#define static
#define CONSTANT const
#define FIXED static CONSTANT
#define INLINE
#define PARAMETER uniform
#define OUT out
static const float kFirst = 0.5;
CONSTANT vec3 kSecond[2] = vec3[](vec3(1.0), vec3(0.0));
FIXED float kThird = 0.5, kFourth = 1.0;
PARAMETER highp float gain;
INLINE void helper(OUT vec2 to) { static float local; CONSTANT float other = 1.0; to.x = local; }
INLINE vec4 apply(vec4 color) { return color * kFirst; }
)");
  EXPECT_THAT(names(scan), ElementsAre("static", "CONSTANT", "FIXED", "INLINE", "PARAMETER", "OUT", "kFirst", "kSecond",
                                       "kThird", "kFourth", "gain", "helper", "apply"));
  EXPECT_FALSE(scan.keeps_state);
  ASSERT_EQ(scan.interface.params.size(), 1u);
  EXPECT_EQ(scan.interface.params[0].line, 10);
  EXPECT_EQ(scan.interface.kind, PassKind::pixel);
  ASSERT_EQ(scan.unset.size(), 2u);
  EXPECT_EQ(scan.unset[0].name, "to");
  EXPECT_EQ(scan.unset[1].name, "local");
}

TEST(Scan, AMacroOfQualifiersWithTwoDefinitionsIsWhatBothHave) {
  const std::string choice = "#ifdef FAST\n#define FIXED lowp const\n#else\n#define FIXED\n#endif\n";
  EXPECT_TRUE(scanned(choice + "FIXED float one = 1.0;\n" + kOwnPixel).keeps_state);
  EXPECT_FALSE(scanned("#define FIXED lowp const\n#undef FIXED\n#define FIXED const\nFIXED float one = 1.0;\n" +
                       std::string(kOwnPixel))
                   .keeps_state);
  EXPECT_THAT(
      names(scanned("#define REAL\n#undef REAL\n#define REAL float\nREAL one = 1.0;\n" + std::string(kOwnPixel))),
      ElementsAre("REAL", "one", "apply"));
}

TEST(Scan, LineContinuationsCountAsLines) {
  const auto scan =
      scanned("#define A(x) \\\n  (x) \\\r\n  + 1.0\nuniform float \\\n t;\nvec4 apply(vec4 c) { return c; }\n");
  ASSERT_EQ(scan.interface.params.size(), 1u);
  EXPECT_EQ(scan.interface.params[0].line, 5);
  EXPECT_THAT(names(scan), ElementsAre("A", "t", "apply"));
}

TEST(Scan, PrototypesOfEntryPointsAreNotDefinitions) {
  EXPECT_EQ(scanned("vec4 apply(vec4 c);\nvec4 apply(vec4 c, vec4 high) { return c; }\n").interface.inputs.size(), 1u);
}

TEST(Scan, ArraysOfParameters) {
  const ShaderScan scan = scanned(
      "#define MANY 9\nconst int few = 3;\nuniform float w[MANY], one, v [ few ];\nuniform vec2 p[0x10];\n"
      "uniform mat3 turn;\nuniform mat4x4 other;\nvec4 apply(vec4 color) { return color * w[2]; }\n");
  const auto& params = scan.interface.params;
  ASSERT_EQ(params.size(), 6u);
  EXPECT_EQ(params[0].elements, 9);
  EXPECT_EQ(params[1].elements, 0);
  EXPECT_EQ(params[2].elements, 3);
  EXPECT_EQ(params[3].elements, 16);
  EXPECT_EQ(params[4].type, ParamType::matrix3);
  EXPECT_EQ(params[5].type, ParamType::matrix4);
}

struct Bad {
  std::string text;
  int line;
  std::string message, allowed = "", nearest = "";
};

class ScanErrors : public testing::TestWithParam<Bad> {};

TEST_P(ScanErrors, NameFileLineAndRemedy) {
  const Bad& bad = GetParam();
  const auto result = scan(bad.text, "f.glsl", ScanAs::stage);
  ASSERT_FALSE(result.ok()) << bad.text;
  const Error& error = result.error();
  EXPECT_EQ(error.kind, ErrorKind::script);
  EXPECT_EQ(error.file, "f.glsl");
  EXPECT_EQ(error.line, bad.line) << error.text();
  EXPECT_THAT(error.message, HasSubstr(bad.message));
  EXPECT_THAT(error.allowed, HasSubstr(bad.allowed));
  EXPECT_EQ(error.nearest, bad.nearest);
}

const std::string kEnd = kOwnPixel;

INSTANTIATE_TEST_SUITE_P(
    Declarations, ScanErrors,
    testing::Values(
        Bad{"uniform vec4 a[256], b[256];\nuniform vec4 c[256], d[256], e;\n" + kEnd, 2, "take more than 16384 bytes"},
        Bad{"#define N 4\n#undef N\n#define N 8\nuniform float a[N];\n" + kEnd, 4, "a whole number, or a name"},
        Bad{"uniform float[2] a;\n" + kEnd, 1, "stands behind the name: uniform float NAME[N];"},
        Bad{"\nuniform float a[0];\n" + kEnd, 2, "'a': the number of elements is a whole number, or a name",
            "1 to 256"},
        Bad{"uniform float a[257];\n" + kEnd, 1, "the number of elements is a whole number, or a name", "1 to 256"},
        Bad{"uniform float a[N];\n" + kEnd, 1, "the number of elements is a whole number, or a name", "1 to 256"},
        Bad{"uniform float a[2][2];\n" + kEnd, 1, "the number of elements is a whole number, or a name", "1 to 256"},
        Bad{"uniform float a[];\n" + kEnd, 1, "the number of elements is a whole number, or a name", "1 to 256"},
        Bad{"uniform float a[2;\n" + kEnd, 1, "'[' is never closed"},
        Bad{"uniform bool a[4];\n" + kEnd, 1, "'a': arrays of this type"},
        Bad{"uniform mat3 a[4];\n" + kEnd, 1, "'a': arrays of this type"},
        Bad{"uniform sampler2D a[4];\n" + kEnd, 1, "'a': arrays of this type"},
        Bad{"\nuniform float apply;\n" + kEnd, 2, "'apply' is a function that the engine calls; choose another name"},
        Bad{"uniform sampler2D sample_at;\n" + kEnd, 1, "'sample_at' is a function that the engine calls"},
        Bad{"uniform mat3x2 m;\n" + kEnd, 1, "cannot be of type 'mat3x2'",
            "float, vec2, vec3, vec4, int, ivec2, bool, mat2, mat3, mat4, sampler2D", "mat2"},
        Bad{"uniform mat4x3 m;\n" + kEnd, 1, "cannot be of type 'mat4x3'",
            "float, vec2, vec3, vec4, int, ivec2, bool, mat2, mat3, mat4, sampler2D", "mat3"},
        Bad{"uniform flaot m;\n" + kEnd, 1, "cannot be of type 'flaot'", "float", "float"},
        Bad{"uniform sampler3D m;\n" + kEnd, 1, "cannot be of type 'sampler3D'", "sampler2D", "sampler2D"},
        Bad{"uniform float a = 1.0;\n" + kEnd, 1, "no default value"},
        Bad{"uniform Block { float a; };\n" + kEnd, 1, "uniform blocks"},
        Bad{"uniform float a\n" + kEnd, 1, "';' is missing"},
        Bad{"uniform float a\nuniform float b;\n" + kEnd, 1, "';' is missing"},
        Bad{"uniform float a;\nuniform vec2 a;\n" + kEnd, 2, "'a' is declared twice"},
        Bad{"uniform float high;\nvec4 apply(vec4 c, vec4 high) { return c; }", 2, "'high' is declared twice"},
        Bad{"layout(binding = 3) uniform sampler2D t;\n" + kEnd, 1, "layout is only known as"},
        Bad{"layout(location = 0) out vec4 o;\n" + kEnd, 1, "'out' is not allowed at file scope"},
        Bad{"\n\nin vec2 uv;\n" + kEnd, 3, "'in' is not allowed at file scope"},
        Bad{"buffer B { float x[]; } b;\n" + kEnd, 1, "'buffer' is not allowed"},
        Bad{"layout(constant_id = 0) const vec2 v = vec2(1);\n" + kEnd, 1, "cannot be of type 'vec2'",
            "bool, int, float"},
        Bad{"layout(constant_id = 0) const int v = 1.5;\n" + kEnd, 1, "must be a literal of type int"},
        Bad{"layout(constant_id = 0) const bool v = 1;\n" + kEnd, 1, "must be a literal of type bool"},
        Bad{"layout(constant_id = 0) const int v = 1 + 1;\n" + kEnd, 1, "must be one literal"},
        Bad{"layout(constant_id = 0) const int v;\n" + kEnd, 1, "needs a default value"},
        Bad{"layout(constant_id = 0) const int a = 1;\nlayout(constant_id = 0) const int b = 1;\n" + kEnd, 2,
            "constant_id 0 is used twice"},
        Bad{"layout() const", 1, "layout is only known as"}, Bad{"layout", 1, "layout needs"},
        Bad{"float helper(float x)\n" + kEnd, 1, "'{' or ';' was expected after helper"},
        Bad{"\nDECLARE(foo)\n" + kEnd, 2, "macros that make declarations"},
        Bad{"float a = 0.0;\n\nstatic float k = 1.0;\n" + kEnd, 3,
            "'static' is no word of GLSL before a declaration; write const"},
        Bad{"groupshared float k[4];\n" + kEnd, 1,
            "'groupshared' is no word of GLSL before a declaration; write shared"},
        Bad{"\ninline float f() { return 1.0; }\n" + kEnd, 2, "'inline' is no word of GLSL before a declaration"},
        Bad{"#define INPUT \\\n in\n\nINPUT vec2 uv;\n" + kEnd, 4, "'in' is not allowed at file scope"},
        Bad{"#define INLINE\n\nINLINE int max(int a) { return a; }\n" + kEnd, 3, "'max' is a built-in function"},
        Bad{"int max(int a) { return a; }\n" + kEnd, 1, "'max' is a built-in function"},
        Bad{"vec4 fetch(int a) { return vec4(a); }\n" + kEnd, 1, "'fetch' is a helper that every shader has"},
        Bad{"#define image_size 3\n" + kEnd, 1, "'image_size' is a helper"},
        Bad{"float x = ag_push;\n" + kEnd, 1, "names that begin with 'ag_'"},
        Bad{"vec4 apply(vec4 c) {\n  discard;\n}\n", 2, "'discard' is not allowed"},
        Bad{"vec4 apply(vec4 c) {\n  return gl_FragCoord;\n}\n", 2,
            "'gl_FragCoord' is not allowed: one invocation may"},
        Bad{"#define WHERE gl_FragCoord\n" + kEnd, 1, "'gl_FragCoord' is not allowed"},
        Bad{"vec4 apply(vec4 c) { gl_FragDepth = 1.0; return c; }\n", 1, "the engine's affair"},
        Bad{"vec4 apply(vec4 c) {\n return dFdy(c);\n}\n", 2, "'dFdy' is not allowed: pixels that lie beside"},
        Bad{"vec4 apply(vec4 c) { return fwidthFine(c); }\n", 1, "'fwidthFine' is not allowed"},
        Bad{"void main() {}\n", 1, "main is made by the engine"},
        Bad{"\nbool done_at(ivec2 p) { return true; }\n" + kEnd, 2, "done_at has other arguments or another result",
            "bool done_at(ivec2 pixel, out vec4 color)"},
        Bad{"\nvec4 done_at(ivec2 p, out vec4 c) { return c; }\n" + kEnd, 2, "done_at has other arguments"},
        Bad{"bool done_at(ivec2 p, out vec4 c) { c = vec4(0.0); return true; }\n" + kEnd, 1,
            "done_at stands beside sample_at alone"},
        Bad{"uniform float size;\n" + kEnd, 1, "'size' is a key of g:pass"},
        Bad{"vec4 apply(vec4 c, vec4 source) { return c; }\n", 1, "'source' is what apply gets as its first argument"},
        Bad{"uniform float reach;\n" + kEnd, 1, "'reach' is a key of g:pass"},
        Bad{"int 5;\n" + kEnd, 1, "a declaration was expected"}, Bad{"float a, ;\n" + kEnd, 1, "a name was expected"},
        Bad{"struct S\n" + kEnd, 2, "'{' was expected after 'struct'"}));

INSTANTIATE_TEST_SUITE_P(
    EntryPoints, ScanErrors,
    testing::Values(Bad{"", 0, "defines none of apply, sample_at, compute_at", "vec4 sample_at(ivec2 pixel)"},
                    Bad{"\nvec4 aply(vec4 c) { return c; }", 2, "defines none of", "", "apply"},
                    Bad{"\nvoid mainImage(out vec4 o, in vec2 at) { o = vec4(at, 0.0, 1.0); }", 2, "defines none of",
                        "", "sample_at"},
                    Bad{"vec4 sampel_at(ivec2 p) { return vec4(0); }", 1, "defines none of", "", "sample_at"},
                    Bad{kEnd + "vec4 sample_at(ivec2 p) { return vec4(0); }", 2,
                        "one of apply, sample_at, compute_at; the other is at line 1"},
                    Bad{kEnd + kEnd, 2, "'apply' is defined a second time; the first is at line 1"},
                    Bad{"vec3 apply(vec4 c) { return c.rgb; }", 1, "apply must return vec4, not vec3",
                        "vec4 apply(vec4 color"},
                    Bad{"vec4 apply() { return vec4(0); }", 1, "takes the colour as its first argument"},
                    Bad{"vec4 apply(void) { return vec4(0); }", 1, "takes the colour as its first argument"},
                    Bad{"vec4 apply(vec3 c) { return vec4(0); }", 1, "argument 'c' of apply must be a vec4"},
                    Bad{"vec4 apply(vec4 c,\n float h) { return vec4(0); }", 2, "argument 'h' of apply must be a vec4"},
                    Bad{"vec4 apply(vec4) { return vec4(0); }", 1, "needs a type and a name"},
                    Bad{"vec4 apply(vec4 c[2]) { return vec4(0); }", 1, "an argument is written TYPE NAME"},
                    Bad{"vec4 apply(inout vec4 c) { return c; }", 1, "'out' and 'inout' are not allowed"},
                    Bad{"vec4 sample_at(vec2 p) { return vec4(0); }", 1, "sample_at takes one argument", "ivec2 pixel"},
                    Bad{"vec4 sample_at(ivec2 p, int q) { return vec4(0); }", 1, "sample_at takes one argument"}));

const std::string kGroups = "layout(local_size_x = 8) in;\n";
const std::string kCompute = "vec4 compute_at(ivec2 p) { return vec4(0); }\n";

INSTANTIATE_TEST_SUITE_P(
    Workgroups, ScanErrors,
    testing::Values(
        Bad{"\n" + kCompute, 2, "a compute shader declares the size of its workgroups", "layout(local_size_x = 16"},
        Bad{kGroups + kEnd, 1, "workgroups are for compute shaders"},
        Bad{"shared vec4 a;\n" + kEnd, 1, "'shared' is for compute shaders"},
        Bad{kGroups + kGroups + kCompute, 2, "the size of workgroups is declared twice"},
        Bad{"layout(local_size_z = 8) in;\n" + kCompute, 1, "the size of workgroups has no 'local_size_z'",
            "local_size_x, local_size_y, pixels_x, pixels_y", "local_size_x"},
        Bad{"layout(local_size_x = 0) in;\n" + kCompute, 1, "'local_size_x' is no size of workgroups", "1…1024"},
        Bad{"layout(local_size_x = N) in;\n" + kCompute, 1, "'local_size_x' is no size of workgroups", "1…1024"},
        Bad{"layout(local_size_x) in;\n" + kCompute, 1, "'local_size_x' is no size of workgroups", "1…1024"},
        Bad{"layout(local_size_x = 64, local_size_y = 32) in;\n" + kCompute, 1, "a workgroup of 64×32 invocations",
            "at most 1024 in all"},
        Bad{"layout(local_size_x = 8, pixels_x = 16) in;\n" + kCompute, 1, "more pixels than it has invocations"},
        Bad{kGroups + "shared mat4 m;\n" + kCompute, 2, "a shared variable cannot be of type 'mat4'", "float, vec2"},
        Bad{kGroups + "shared vec4 m[2][2];\n" + kCompute, 2, "'m': shared arrays have one dimension"},
        Bad{kGroups + "shared float m = 1.0;\n" + kCompute, 2, "'m': a shared variable begins as zeros"},
        Bad{kGroups + "float a;\nvec4 compute_at(int p) { return vec4(0); }\n", 3, "compute_at takes one argument",
            "vec4 compute_at(ivec2 pixel)"}));

INSTANTIATE_TEST_SUITE_P(
    Preprocessor, ScanErrors,
    testing::Values(Bad{"#version 450\n" + kEnd, 1, "#version is given by the engine", "#include"},
                    Bad{"\n#extension GL_foo : enable\n" + kEnd, 2, "#extension is not allowed"},
                    Bad{"#line 7\n" + kEnd, 1, "#line is not allowed"},
                    Bad{"#pragma optimize(off)\n" + kEnd, 1, "#pragma is not allowed"},
                    Bad{"#inclde \"x.glsl\"\n" + kEnd, 1, "#inclde is not allowed", "", "#include"},
                    Bad{"#include <x.glsl>\n" + kEnd, 1, "an include is written #include \"lib/NAME.glsl\""},
                    Bad{"#include \"x.glsl\" 1\n" + kEnd, 1, "an include is written"},
                    Bad{"#include \"x.glsl\n" + kEnd, 1, "never closed"},
                    Bad{"#if 1\n" + kEnd, 1, "#if is never closed"}, Bad{"#endif\n" + kEnd, 1, "#endif without #if"},
                    Bad{"#undef VULKAN\n" + kEnd, 1, "only macros of this file can be undefined"},
                    Bad{"#define\n" + kEnd, 1, "#define needs a name"},
                    Bad{"#define J(a, b) a ## b\n" + kEnd, 1, "token pasting"}));

INSTANTIATE_TEST_SUITE_P(Characters, ScanErrors,
                         testing::Values(Bad{"/* a\n b\n" + kEnd, 1, "the comment is never closed"},
                                         Bad{"float a = (1.0};\n" + kEnd, 1, "does not close the '('"},
                                         Bad{"\nvec4 apply(vec4 c) { return c;\n", 2, "'{' is never closed"},
                                         Bad{"}\n" + kEnd, 1, "'}' closes nothing"},
                                         Bad{"float a = \"text\";\n" + kEnd, 1, "no text in quotes"},
                                         Bad{"float a = 1 @ 2;\n" + kEnd, 1, "unexpected character '@'"},
                                         Bad{"float caf\xc3\xa9;\n" + kEnd, 1, "unexpected character '\xc3\xa9'"},
                                         Bad{"float a = 1.0 \xe2\x80\x93 2.0;\n" + kEnd, 1, "; write -"},
                                         Bad{"float a =\xc2\xa0"
                                             "1.0;\n" +
                                                 kEnd,
                                             1, "no-break space; write a plain one"},
                                         Bad{"float a = \xe2\x80;\n" + kEnd, 1, "unexpected character (byte 0xe2)"},
                                         Bad{std::string("float a\0;\n", 10) + kEnd, 1,
                                             "unexpected character (byte 0x00)"},
                                         Bad{"float a; # define B\n" + kEnd, 1, "'#' must be the first character"}));

TEST(Scan, LibrariesDeclareNoParametersAndNoEntryPoints) {
  const auto message = [](const std::string& text) {
    const auto result = scan(text, "lib.glsl", ScanAs::library);
    return result.ok() ? std::string("ok") : result.error().text();
  };
  EXPECT_EQ(message("float twice(float x) { return 2.0 * x; }\n"), "ok");
  EXPECT_EQ(message(""), "ok");
  EXPECT_THAT(message("uniform float a;"), HasSubstr("lib.glsl:1: error: a library declares no uniforms"));
  EXPECT_THAT(message("\nlayout(constant_id = 0) const int a = 1;"),
              HasSubstr("lib.glsl:2: error: a library declares no parameters"));
  EXPECT_THAT(message("vec4 apply(vec4 c) { return c; }"), HasSubstr("'apply' is defined in an included file"));
}

}  // namespace
}  // namespace afterglow
