// SPDX-License-Identifier: MIT
// Any authors' shaders in one kernel: names never clash, lines stay where they are.
#include <gmock/gmock.h>

#include "shader/rename.h"
#include "shader_files.h"

namespace afterglow {
namespace {

using testing::HasSubstr;
using testing::Not;

KernelDesc join(std::vector<KernelStage> stages) {
  KernelDesc kernel;
  kernel.stages = std::move(stages);
  return kernel;
}

std::string outcome(const KernelDesc& kernel) {
  KernelCompiler compiler{std::filesystem::path()};
  const auto result = compiler.compile(kernel);
  return result.ok() ? "ok" : result.error().text();
}

std::string assembled(const KernelDesc& kernel) {
  const auto result = assemble(kernel);
  return result.ok() ? result->glsl : result.error().text();
}

constexpr const char* kFirst = R"(#include "lib/shared.glsl"
#define STRENGTH 2.0
#define SCALE(x) ((x) * STRENGTH)
uniform float amount;
layout(constant_id = 0) const int mode = 1;
struct Light { vec3 color; float amount; };
const float kTable[2] = float[](1.0, 2.0);
float state = 0.5;
float curve(float x) { return shared_curve(x) * SCALE(kTable[1]) + state; }
vec4 apply(vec4 color, vec4 high) {
  Light light = Light(color.rgb, amount);
  light.amount = light.amount * light.color.r;
  return mode == 1 ? vec4(light.color * curve(light.amount), color.a) : high;
}
)";

constexpr const char* kSecond = R"(#include "lib/other.glsl"
#define STRENGTH vec3(1.0, 0.5, 0.25)
#define SCALE 3.0
uniform vec3 amount;
layout(constant_id = 0) const bool mode = true;
struct Light { float curve; };
vec3 kTable() { return vec3(1.0); }
vec4 state(vec4 c) { return c; }
Light curve(vec3 x) { return Light(dot(x, STRENGTH) * SCALE); }
vec4 apply(vec4 high, vec4 color) {
  float shared_curve = curve(amount).curve;
  return mode ? state(color) * shared_curve * shared_helper() : high * kTable().x;
}
)";

class Join : public testing::Test {
 protected:
  void SetUp() override {
    files_.write("lib/shared.glsl", "#define PI 3.14159\nfloat shared_curve(float x) { return x * PI; }\n");
    files_.write(
        "lib/other.glsl",
        "const float PI = 3.0;\nfloat shared_helper() { return PI; }\nfloat shared_curve_2() { return 1.0; }\n");
  }
  ShaderFiles files_;
};

TEST_F(Join, ClashingNamesOfTwoAuthors) {
  const auto first = files_.stage("a/x", kFirst), second = files_.stage("b/y", kSecond);
  EXPECT_EQ(outcome(join({first})), "ok");
  EXPECT_EQ(outcome(join({second})), "ok");
  EXPECT_EQ(outcome(join({first, second})), "ok");
  EXPECT_EQ(outcome(join({second, first})), "ok");
  EXPECT_EQ(outcome(join({first, second, first, second})), "ok");
}

TEST_F(Join, TheSameShaderTwiceHasTwoSetsOfParameters) {
  KernelCompiler compiler{std::filesystem::path()};
  const auto stage = files_.stage("a/x", kFirst);
  auto other = stage;
  other.constants["mode"] = 7;
  const auto kernel = compiler.compile(join({stage, other}));
  ASSERT_TRUE(kernel.ok()) << kernel.error().text();
  ASSERT_EQ(kernel->params.size(), 2u);
  EXPECT_EQ(kernel->params[0].name, "amount");
  EXPECT_EQ(kernel->params[1].name, "amount");
  EXPECT_EQ(kernel->params[0].stage, 0);
  EXPECT_EQ(kernel->params[1].stage, 1);
  EXPECT_NE(kernel->params[0].offset, kernel->params[1].offset);
  ASSERT_EQ(kernel->images.size(), 3u);
  EXPECT_EQ(kernel->images[1].stage, 0);
  EXPECT_EQ(kernel->images[2].stage, 1);
  const auto text = assembled(join({stage, other}));
  EXPECT_THAT(text, HasSubstr("const int ag_s0_mode = 1;"));
  EXPECT_THAT(text, HasSubstr("const int ag_s1_mode = 7;"));
}

TEST_F(Join, ALibraryStandsOnceInAKernel) {
  const auto a = files_.stage("a/x", kFirst);
  const auto b =
      files_.stage("c/z", "#include \"lib/shared.glsl\"\nvec4 apply(vec4 c) { return c * shared_curve(1.0); }\n");
  const auto text = assembled(join({a, b, a}));
  const auto first = text.find("float ag_l0_shared_curve(float x)");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(text.find("_shared_curve(float x)", first + 30), std::string::npos);
  EXPECT_EQ(outcome(join({a, b, a})), "ok");
}

/// A generator of random numbers: each pass begins with its first one, fused or not.
TEST_F(Join, ALibraryThatKeepsSomethingStandsOnceForEachStage) {
  files_.write(
      "lib/random.glsl",
      "uint state = 12345u;\nfloat next() { state = state * 1664525u + 1013904223u; return float(state >> 24); "
      "}\n");
  files_.write("lib/uses.glsl", "#include \"lib/random.glsl\"\nfloat twice() { return next() + next(); }\n");
  const auto a = files_.stage("a/x",
                              "#include \"lib/random.glsl\"\n#include \"lib/uses.glsl\"\n"
                              "vec4 apply(vec4 c) { return c + next() + twice(); }\n");
  const auto text = assembled(join({a, a}));
  for (const char* mine :
       {"uint ag_l0_state = 12345u;", "ag_l0_next() + ag_l0_next()", "c + ag_l0_next() + ag_l1_twice()",
        "uint ag_l2_state = 12345u;", "ag_l2_next() + ag_l2_next()", "c + ag_l2_next() + ag_l3_twice()"})
    EXPECT_THAT(text, HasSubstr(mine));
  EXPECT_EQ(outcome(join({a, a})), "ok");
}

TEST_F(Join, LibrariesOfOneNameFromTwoFoldersStandApart) {
  files_.write("a/helper.glsl", "float helper() { return 1.0; }\n");
  files_.write("b/helper.glsl", "float helper() { return 2.0; }\n");
  const std::string text = "#include \"helper.glsl\"\nvec4 apply(vec4 c) { return c * helper(); }\n";
  const auto kernel = join({files_.stage("a/x", text), files_.stage("b/x", text)});
  EXPECT_EQ(outcome(kernel), "ok");
  const auto glsl = assembled(kernel);
  EXPECT_THAT(glsl, HasSubstr("float ag_l0_helper() { return 1.0; }"));
  EXPECT_THAT(glsl, HasSubstr("float ag_l1_helper() { return 2.0; }"));
  EXPECT_THAT(glsl, HasSubstr("return c * ag_l0_helper();"));
  EXPECT_THAT(glsl, HasSubstr("return c * ag_l1_helper();"));
}

TEST_F(Join, ALibrarySeesNoMacrosOfTheShader) {
  files_.write("lib/plain.glsl", "float plain(float gain) { return gain; }\n");
  EXPECT_EQ(outcome(join({files_.stage("a",
                                       "#define gain 3.0 +\n#define float vec4\n#include \"lib/plain.glsl\"\nvec4 "
                                       "apply(vec4 c) { return c * plain(1.0); }\n")})),
            "ok");
}

TEST_F(Join, AMacroOfOneShaderDoesNotReachTheNext) {
  const auto hostile = files_.stage(
      "a", "#define c 1.0 +\n#define clamp broken\n#define return 0 +\nvec4 apply(vec4 color) { return_ = 1.0; }\n");
  const auto innocent = files_.stage("b", "vec4 apply(vec4 c) { return c; }\n");
  EXPECT_THAT(outcome(join({hostile, innocent})), HasSubstr("a.glsl:4: error: 'return_': undeclared identifier"));
  EXPECT_EQ(outcome(join(
                {files_.stage("d", "#define c 1.0\n#define min max\nvec4 apply(vec4 x) { return x * min(c, 2.0); }\n"),
                 innocent})),
            "ok");
}

TEST_F(Join, MacrosOfQualifiersStayWhereTheyAre) {
  const std::string text =
      "#define static\n#define PARAMETER uniform\n#define INLINE\n#define FIXED const\n"
      "static const float kGain = 0.5;\nINLINE static PARAMETER float amount;\n"
      "layout(constant_id = 0) FIXED int count = 2;\nINLINE FIXED float kHalf[2] = float[](0.5, 0.5);\n"
      "INLINE float half_of(FIXED float x) { return x * kHalf[1]; }\n"
      "INLINE vec4 apply(vec4 c) { static FIXED float gain = kGain; return c * half_of(gain) * amount; }\n";
  EXPECT_EQ(outcome(join({files_.stage("a", text), files_.stage("b", text)})), "ok");
  EXPECT_THAT(outcome(join({files_.stage("c", text + "float late = wrong;\n")})),
              HasSubstr("c.glsl:11: error: 'wrong'"));
}

TEST_F(Join, FieldsAndSwizzlesKeepTheirNames) {
  const std::string text = R"(struct Pair { float xy; vec2 rgb[2]; } ;
float xy(float rgb) { return rgb; }
float rgb = 1.0;
#define ALPHA a
vec4 apply(vec4 color) {
  Pair pair = Pair(xy(rgb), vec2[](color.xy, color.rg));
  struct Local { float rgb, xy; } local;
  local.rgb = pair.xy; local.xy = pair.rgb[1].x;
  return vec4(color.rgb * local.xy + local.rgb, color.ALPHA);
}
)";
  EXPECT_EQ(outcome(join({files_.stage("a", text), files_.stage("b", text)})), "ok");
}

TEST_F(Join, FieldsThatMacrosAreGivenKeepTheirNames) {
  files_.write("lib/get.glsl", "#define OF(v, f) v.f\n");
  const std::string text = R"(#include "lib/get.glsl"
uniform float x, rg;
uniform vec4 v;
struct Pair { vec4 rg; };
#define GET(f) color.f
#define AGAIN(w, f) (w * GET(f))
#define TWICE(x, rg) (x + x) * rg
#define SWIZZLE(x) v.x
vec4 apply(vec4 color) {
  Pair pair = Pair(color);
  return vec4(GET(x), AGAIN(x, x) * TWICE(x, rg), OF(v, rg) * SWIZZLE(y)) + GET(rg.x) + OF(pair, rg.x) + OF(v, x);
}
)";
  EXPECT_EQ(outcome(join({files_.stage("a", text), files_.stage("b", text)})), "ok");
  const auto glsl = assembled(join({files_.stage("a", text)}));
  EXPECT_THAT(glsl, HasSubstr("ag_s0_AGAIN(ag_s0_x, x) * ag_s0_TWICE(ag_s0_x, ag_s0_rg), ag_l0_OF(ag_s0_v, rg)"));
  EXPECT_THAT(glsl, HasSubstr("#define ag_s0_SWIZZLE(x) ag_s0_v.x\n"));
  EXPECT_THAT(glsl, HasSubstr("#define ag_s0_TWICE(x, rg) (x + x) * rg\n"));
}

TEST_F(Join, AnArgumentThatIsMoreThanAFieldIsAName) {
  const std::string text =
      "uniform float gain;\n#ifdef WIDE\n#define GET(f) color.f\n#else\n#define GET(f) (f)\n#endif\n"
      "#define BOTH(f) (f + f)\nvec4 apply(vec4 color) { return color * GET(gain) * BOTH(gain); }\n";
  EXPECT_EQ(outcome(join({files_.stage("a", text), files_.stage("b", text)})), "ok");
}

TEST_F(Join, FieldsNamedLikeMacrosWithArgumentsKeepTheirNames) {
  const std::string text =
      "#define r(a) mat2(cos(a), sin(a), -sin(a), cos(a))\n#define fbm(p) fract(p)\nstruct Noise { float fbm; };\n"
      "vec4 apply(vec4 c) { Noise n = Noise(fbm(c.r * 2.0)); c.rg *= r(n.fbm + c.r * 2.0); return c; }\n";
  EXPECT_EQ(outcome(join({files_.stage("a", text), files_.stage("b", text)})), "ok");
}

TEST_F(Join, UnderscoresAreNoTrouble) {
  const std::string text =
      "#define _K 2.0\n#define __K 3.0\nuniform float _t;\nfloat __f(float _x) { return _x * _K * __K; }\n"
      "vec4 apply(vec4 c) { return c * __f(_t); }\n";
  EXPECT_EQ(outcome(join({files_.stage("a", text), files_.stage("b", text)})), "ok");
}

TEST_F(Join, UniformsMayBeShadowedByLocals) {
  EXPECT_EQ(
      outcome(join({files_.stage("a", "uniform float t;\nvec4 apply(vec4 c) { float t = t * 2.0; return c * t; }\n")})),
      "ok");
}

TEST_F(Join, ConditionalTextIsKept) {
  const std::string text = R"(#define FAST
#ifdef FAST
float f() { return 1.0; }
#else
float f() { return broken; }
#endif
#if defined(FAST) && !defined(SLOW)
#undef FAST
#endif
vec4 apply(vec4 c) { return c * f(); }
)";
  EXPECT_EQ(outcome(join({files_.stage("a", text), files_.stage("b", text)})), "ok");
}

TEST_F(Join, LinesOfErrorsInEachPart) {
  const std::string good = "uniform\n  float\n  t;\nvec4 apply(vec4 c) { return c * t; }\n";
  const std::string bad =
      "uniform\n  float\n  t;\n/* two\nlines */\nvec4 apply(vec4 c) {\n  return c * undefined_name;\n}\n";
  const std::string at_a = files_.path("a.glsl").string() + ":", at_b = files_.path("b.glsl").string() + ":";
  EXPECT_THAT(outcome(join({files_.stage("a", bad), files_.stage("b", good)})),
              HasSubstr(at_a + "7: error: 'undefined_name': undeclared identifier"));
  EXPECT_THAT(outcome(join({files_.stage("a", good), files_.stage("b", bad)})),
              HasSubstr(at_b + "7: error: 'undefined_name': undeclared identifier"));
  files_.write("lib/broken.glsl", "// one\n\nfloat broken() {\n  return vec3(1.0);\n}\n");
  const auto including =
      files_.stage("c", "\n#include \"lib/broken.glsl\"\nvec4 apply(vec4 c) { return c * broken(); }\n");
  EXPECT_THAT(outcome(join({files_.stage("a", good), including})),
              HasSubstr(files_.path("lib/broken.glsl").string() + ":4: error: "));
  const auto sample = files_.stage("d", "\nvec4 sample_at(ivec2 p) {\n  return vec3(p, 0);\n}\n");
  KernelDesc kernel;
  kernel.sample = sample;
  kernel.stages = {files_.stage("a", good)};
  EXPECT_THAT(outcome(kernel), HasSubstr(files_.path("d.glsl").string() + ":3: error: "));
}

TEST_F(Join, MessagesUseTheAuthorsNames) {
  const auto text = outcome(join({files_.stage(
      "a", "uniform float threshold;\nvec4 apply(vec4 c) { return threshold; }\nint f() { threshold = 1.0; }\n")}));
  EXPECT_THAT(text, Not(HasSubstr("ag_s0_")));
  EXPECT_EQ(original_names("'ag_s12_x' ag_l3_y ag_r1_fetch ag_pixel ag_s_z ag_s1"),
            "'x' y fetch ag_pixel ag_s_z ag_s1");
}

TEST_F(Join, LongMessagesAreCut) {
  std::string text = "struct S {";
  for (int i = 0; i < 200; ++i) text += " float field_" + std::to_string(i) + ";";
  const auto result = KernelCompiler{std::filesystem::path()}.compile(
      join({files_.stage("a", text + "};\nS s;\nvec4 apply(vec4 c) {\n  c = s; return c;\n}\n")}));
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().line, 4);
  EXPECT_THAT(result.error().message, HasSubstr("structure{"));
  EXPECT_LE(result.error().message.size(), 310u);
}

TEST_F(Join, TextIsIndependentOfPassNamesAndPlaces) {
  ShaderFiles elsewhere;
  const std::string text = "uniform float t;\nvec4 apply(vec4 c) { return c * t; }\n";
  auto a = files_.stage("a", text), b = elsewhere.stage("other/b", text);
  a.label = "bloom.up[0]";
  b.label = "bloom.up[1]";
  EXPECT_EQ(assemble(join({a}))->hash, assemble(join({b}))->hash);
}

TEST_F(Join, SampleHeadsBindTheirSamplers) {
  KernelDesc kernel;
  kernel.sample =
      files_.stage("edge",
                   "uniform sampler2D depth;\nuniform float w;\nuniform sampler2D normal;\n"
                   "vec4 sample_at(ivec2 pixel) { return fetch(depth, pixel + 1) * w + fetch(normal, pixel) + "
                   "sample_scaled(depth, pixel, ivec2(1, 0)) +\n"
                   "  fetch_linear(normal, vec2(pixel)) + vec4(vec2(image_size(depth)), vec2(target_size())); }\n");
  kernel.stages = {files_.stage(
      "mix",
      "uniform sampler2D lut;\nvec4 apply(vec4 c, vec4 high) { return mix(c, high, fetch(lut, ivec2(0)).r); }\n")};
  const auto result = KernelCompiler{std::filesystem::path()}.compile(kernel);
  ASSERT_TRUE(result.ok()) << result.error().text();
  std::vector<std::pair<int, std::string>> slots;
  for (const auto& image : result->images) slots.emplace_back(image.stage, image.name);
  EXPECT_THAT(slots, testing::ElementsAre(std::pair{0, std::string("depth")}, std::pair{0, std::string("normal")},
                                          std::pair{1, std::string("lut")}, std::pair{1, std::string("high")}));
}

TEST_F(Join, WrongKindsAndTooManyImagesAreRefused) {
  const auto sample = files_.stage("s", "vec4 sample_at(ivec2 p) { return vec4(0); }\n");
  EXPECT_THAT(outcome(join({sample})), HasSubstr("'s' is a sample shader and cannot stand here"));
  KernelDesc kernel;
  kernel.sample = files_.stage("p", "vec4 apply(vec4 c) { return c; }\n");
  EXPECT_THAT(outcome(kernel), HasSubstr("'p' is a pixel shader and cannot stand here"));
  const auto many = files_.stage("m", "vec4 apply(vec4 c, vec4 a, vec4 b, vec4 d, vec4 e) { return a + b + d + e; }\n");
  EXPECT_EQ(outcome(join({many, many, many})), "ok");
  EXPECT_THAT(outcome(join({many, many, many, many})),
              HasSubstr("pass 'm' reads 17 images, with its source; allowed: at most 16"));
}

TEST_F(Join, ConstantsThatDoNotFitAreRefused) {
  auto stage =
      files_.stage("a", "\nlayout(constant_id = 0) const int n = 1;\nvec4 apply(vec4 c) { return c * float(n); }\n");
  stage.constants["n"] = 1e12;
  EXPECT_THAT(outcome(join({stage})), HasSubstr("a.glsl:2: error: constant 'n' cannot be"));
}

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

TEST_F(Join, NeighboursThatWantStraightColourDivideOnce) {
  const auto plain = files_.stage("a/plain", "vec4 apply(vec4 c) { return c * 2.0; }\n");
  auto straight = files_.stage("a/curve", "vec4 apply(vec4 c) { return sqrt(c); }\n");
  straight.straight = true;
  const auto divisions = [&](std::vector<KernelStage> stages) {
    const auto text = assembled(join(stages));
    EXPECT_EQ(outcome(join(stages)), "ok");
    EXPECT_EQ(count_of(text, "/ ag_cover"), count_of(text, "* ag_cover"));
    return count_of(text, "/ ag_cover");
  };
  EXPECT_EQ(divisions({plain, plain}), 0u);
  EXPECT_EQ(divisions({straight}), 1u);
  EXPECT_EQ(divisions({plain, straight, straight, straight, plain}), 1u);
  EXPECT_EQ(divisions({straight, plain, straight, straight}), 2u);
}

TEST_F(Join, StagesTakeColoursOfEarlierOnes) {
  auto effect = files_.stage("a/effect", "vec4 apply(vec4 c) { return c * 2.0; }\n");
  auto mask = files_.stage("a/mask", "vec4 apply(vec4 c) { return c.rrrr; }\n");
  auto blend = files_.stage("a/blend", "vec4 apply(vec4 c, vec4 below, vec4 mask) { return mix(below, c, mask); }\n");
  effect.straight = true;
  mask.color = 0;  // of the anchor, not of the effect
  blend.color = 1;
  blend.values = {{"below", 0}, {"mask", 2}};
  const KernelDesc kernel = join({effect, mask, blend});
  EXPECT_EQ(outcome(kernel), "ok");
  const auto made = assemble(kernel);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->images.size(), 1u);  // the anchor's
  EXPECT_THAT(made->glsl, HasSubstr("ag_color = ag_s2_apply(ag_color, ag_value0, ag_value2);"));
  EXPECT_EQ(count_of(made->glsl, "/ ag_cover"), 1u);

  // Two stages that read one image at their pixel read it once.
  mask.color = kOwnImage;
  blend.values.erase("below");
  blend.again["below"] = {1, "source"};
  const auto shared = assemble(join({effect, mask, blend}));
  ASSERT_TRUE(shared);
  ASSERT_EQ(shared->images.size(), 2u);
  EXPECT_EQ(shared->images[1].stage, 1);
  EXPECT_EQ(shared->images[1].name, "source");
  EXPECT_EQ(outcome(join({effect, mask, blend})), "ok");
}

TEST_F(Join, UniformsMayBeUnread) {
  KernelCompiler compiler{std::filesystem::path()};
  int number = 0;
  for (const char* uniforms : {"uniform float k;\n", "uniform float k;\nuniform vec3 other;\n"}) {
    const auto made = compiler.compile(join({files_.stage(
        "a/unread" + std::to_string(number++), std::string(uniforms) + "vec4 apply(vec4 c) { return c; }\n")}));
    ASSERT_TRUE(made) << made.error().text();
    // A compiler may leave the block out or keep it: bytes are given for what is there.
    EXPECT_EQ(made->params.empty(), made->block_size == 0);
  }
}

}  // namespace
}  // namespace afterglow
