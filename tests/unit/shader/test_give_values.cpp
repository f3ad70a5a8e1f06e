// SPDX-License-Identifier: MIT
// Variables that authors declare without a value: they are 0, at every turn of a loop and in every call, and those that
// may be read so are told by file and line.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <cstring>
#include <spirv-tools/libspirv.hpp>

#include "kernel_runner.h"
#include "shader/give_values.h"
#include "shader_files.h"

namespace afterglow {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

struct Made {
  std::vector<std::string> warnings;
  std::array<float, 4> pixel{};
};

/// What a pixel shader makes of the colour (0.5, 0.25, 2, 1), and what the compiler says of it.
Made made(const std::string& shader, int rows = 1, bool hide = true) {
  static KernelRunner runner;
  const ShaderFiles files;
  KernelCompiler compiler({});
  KernelDesc desc;
  desc.stages = {files.stage("test/unset", shader)};
  desc.config.rows = rows;
  desc.config.defeat_uniform_inlining = hide;
  const auto kernel = compiler.compile(desc);
  Made out;
  EXPECT_TRUE(kernel) << kernel.error().text();
  if (!kernel) return out;
  EXPECT_TRUE(spvtools::SpirvTools(SPV_ENV_VULKAN_1_1).Validate(kernel->spirv));
  for (const auto& warning : kernel->warnings) {
    EXPECT_THAT(warning, testing::StartsWith(files.path("test/unset.glsl").string() + ":"));
    out.warnings.push_back(warning.substr(warning.find(".glsl:") + 6));
  }
  TestImage image{{9, 16}, {}};
  for (long long i = 0; i < image.size.area(); ++i) image.rgba.insert(image.rgba.end(), {0.5f, 0.25f, 2.f, 1.f});
  const TestImage result = runner.run(*kernel, {image}, image.size);
  std::memcpy(out.pixel.data(), result.at(4, 5), sizeof out.pixel);
  for (int y = 0; y < image.size.height; ++y)
    EXPECT_EQ(std::memcmp(result.at(4, y), out.pixel.data(), sizeof out.pixel), 0) << "row " << y;
  EXPECT_EQ(runner.validation_errors(), 0);
  return out;
}

std::string read_at(int line, const std::string& name) {
  return std::to_string(line) + ": '" + name + "' may be read before it has a value; it is 0 there";
}

TEST(GiveValues, AVariableIsZero) {
  for (const int rows : {1, 8}) {
    const Made one = made("vec4 apply(vec4 color) {\n  float u;\n  return color + u;\n}\n", rows);
    EXPECT_THAT(one.warnings, ElementsAre(read_at(2, "u")));
    EXPECT_THAT(one.pixel, ElementsAre(0.5f, 0.25f, 2.f, 1.f));
  }
}

TEST(GiveValues, EachOfADeclaration) {
  const Made one = made(
      "vec4 apply(vec4 color) {\n  highp float a = 1.0, b,\n    c;\n  ivec2 d, e = ivec2(1);\n  bvec3 f;\n"
      "  return vec4(a + b, c, d.x + e.y, f.y ? 1.0 : 2.0);\n}\n");
  EXPECT_THAT(one.warnings, ElementsAre(read_at(2, "b"), read_at(3, "c"), read_at(4, "d"), read_at(5, "f")));
  EXPECT_THAT(one.pixel, ElementsAre(1.f, 0.f, 1.f, 2.f));
}

TEST(GiveValues, OnlyOneBranchGivesIt) {
  const Made one =
      made("vec4 apply(vec4 color) {\n  vec3 u;\n  if (color.r > 9.0) u = color.rgb;\n  return vec4(u, 1.0);\n}\n");
  EXPECT_THAT(one.warnings, ElementsAre(read_at(2, "u")));
  EXPECT_THAT(one.pixel, ElementsAre(0.f, 0.f, 0.f, 1.f));
}

TEST(GiveValues, WhatIsAlwaysGivenIsNotTold) {
  EXPECT_THAT(
      made("vec4 apply(vec4 color) {\n  vec3 u; float v;\n  if (color.r > 9.0) u = color.rgb; else u = vec3(1.0);\n"
           "  v = 2.0;\n  return vec4(u, v);\n}\n")
          .warnings,
      IsEmpty());
  EXPECT_THAT(made("vec4 apply(vec4 color) {\n  vec3 u;\n  u.x = 1.0; u.z = 2.0;\n  u.y = color.r;\n  return vec4(u, "
                   "1.0);\n}\n")
                  .warnings,
              IsEmpty());
  EXPECT_THAT(made("struct Pair { float a; vec2 b; };\nvec4 apply(vec4 color) {\n  Pair p;\n  p.a = color.r;\n"
                   "  p.b = color.gb;\n  return vec4(p.a, p.b, 1.0);\n}\n")
                  .warnings,
              IsEmpty());
  EXPECT_THAT(made("void both(vec4 color, out float a, out vec3 b) { a = color.a; b = color.rgb; }\n"
                   "vec4 apply(vec4 color) {\n  float a;\n  vec3 b;\n  both(color, a, b);\n  return vec4(b, a);\n}\n")
                  .warnings,
              IsEmpty());
  EXPECT_THAT(made("vec4 apply(vec4 color) {\n  float y[4];\n  for (int i = 0; i < 4; ++i) y[i] = color[i];\n"
                   "  return vec4(y[3], y[2], y[1], y[0]);\n}\n")
                  .warnings,
              IsEmpty());
  // Sectors of a filter: all are given, some are added to, and components of each are read.
  EXPECT_THAT(made("vec4 apply(vec4 color) {\n  vec4 m[8];\n  for (int k = 0; k < 8; k++) m[k] = vec4(0.0);\n"
                   "  for (int y = 0; y <= int(color.r * 4.0); y++)\n"
                   "    for (int k = 0; k < 8; k++) m[k] += vec4(color.rgb, 1.0);\n  vec4 o = vec4(0.0);\n"
                   "  for (int k = 0; k < 8; k++) o += vec4(m[k].rgb / max(m[k].w, 1e-6), 1.0);\n  return o;\n}\n")
                  .warnings,
              IsEmpty());
  EXPECT_THAT(made("vec4 apply(vec4 color) {\n  vec4 m[4];\n  for (int k = 0; k < 3; k++) m[k] = vec4(0.0);\n"
                   "  for (int y = 0; y <= int(color.r * 4.0); y++)\n"
                   "    for (int k = 0; k < 3; k++) m[k] += vec4(color.rgb, 1.0);\n"
                   "  return vec4(m[0].rgb / m[1].w, m[3].w);\n}\n")
                  .warnings,
              ElementsAre(read_at(2, "m")));
  EXPECT_THAT(made("vec4 apply(vec4 color) {\n  float y[3], sum = 0.0;\n  y[0] = 1.0; y[2] = color.r; y[1] = color.g;\n"
                   "  for (int i = 0; i < 3; ++i) sum += y[i];\n  return vec4(sum);\n}\n")
                  .warnings,
              IsEmpty());
  EXPECT_THAT(made("float w[3];\nvec4 apply(vec4 color) {\n  for (int i = 0; i < 3; ++i) w[i] = float(i);\n"
                   "  float sum = 0.0;\n  for (int i = 2; i >= 0; --i) { sum += w[i]; if (sum > color.r) break; }\n"
                   "  return vec4(sum);\n}\n")
                  .warnings,
              IsEmpty());
  EXPECT_THAT(made("vec4 apply(vec4 color) {\n  float y[3], sum = 0.0;\n"
                   "  for (int i = 0; i < 3; ++i) sum += y[i];\n  return vec4(sum);\n}\n")
                  .warnings,
              ElementsAre(read_at(2, "y")));
}

TEST(GiveValues, PartsThatAreGivenOneByOneAreNotTold) {
  const std::string one = "struct One { float a; vec2 b; };\n", two = "struct Two { One o; vec3 d; };\n";
  for (const std::string& shader : {
           one + "vec4 apply(vec4 color) { One s; s.a = 1.0; s.b.x = 2.0; s.b.y = 2.0; return color + s.a + s.b.y; }\n",
           one + two +
               "Two make() { Two r; r.o.a = 1.0; r.o.b.xy = vec2(1.0); r.d.xy = vec2(2.0); r.d.z = 1.0; return r; }\n"
               "vec4 apply(vec4 color) { Two r = make(); return color + r.o.b.y + r.d.z; }\n",
           std::string("vec4 apply(vec4 color) { vec2 q[2]; q[0].x = 1.0; q[0].y = 2.0; q[1] = vec2(0.0);\n"
                       "  return color + q[0].y + q[1].x; }\n"),
           std::string(
               "vec4 apply(vec4 color) { mat2 m; m[0] = vec2(1.0); m[1] = vec2(2.0); return color + m[1].x; }\n"),
           std::string("vec4 apply(vec4 color) { mat3 m; for (int i = 0; i < 3; ++i) m[i] = color.rgb;\n"
                       "  return vec4(m * color.rgb, 1.0); }\n"),
           std::string("vec4 apply(vec4 color) { vec3 v; v.zx = color.rg; v.y = v.x; return v.zyxx; }\n"),
       })
    EXPECT_THAT(made(shader).warnings, IsEmpty()) << shader;
  // All but one of them.
  for (const std::string& shader : {
           one + "vec4 apply(vec4 color) {\n  One s; s.a = 1.0; s.b.x = 2.0; return color + s.a + s.b.y; }\n",
           std::string(
               "vec4 apply(vec4 color) {\n  vec2 s[2]; s[0].x = 1.0; s[1] = vec2(0.0); return color + s[0].y; }\n"),
           std::string("vec4 apply(vec4 color) {\n  mat2 s; s[0] = vec2(1.0); return color + s[1].x; }\n"),
           std::string("vec4 apply(vec4 color) {\n  vec3 s; s.xy = vec2(1.0); return s.xyzx; }\n"),
       })
    EXPECT_THAT(made(shader).warnings, ElementsAre(read_at(one == shader.substr(0, one.size()) ? 3 : 2, "s")))
        << shader;
}

TEST(GiveValues, WhatATurnOfALoopGivesIsNotTold) {
  for (const char* body : {
           "float a; int i = 0; do { a = float(i); } while (++i < 3); return color + a;",
           "float a; int i = 0; do { a = color.r * float(i); ++i; } while (a < color.g); return color + a;",
           "float t; for (int i = 0; i < 3; ++i) t = float(i); return color + t;",
           "float t; for (int i = 0; i < 300; ++i) t = color[i & 3]; return color + t;",
           "float t, u; for (int i = 0; i < 300; ++i) { t = color.r; for (int k = 0; k < 40; ++k) u = t; }"
           " return color + u;",
           "vec2 t; for (int i = 0; i < 300; ++i) { t.x = color[i & 3]; t.y = t.x; } return color + t.y;",
           "float best; for (int i = 0; i < 4; ++i) { float v = color[i]; if (i == 0 || v > best) best = v; }"
           " return color + best;",
           "float best; for (int y = -1; y <= 1; ++y) for (int x = -1; x <= 1; ++x) { float v = color.r * float(x);"
           " if (x == -1 && y == -1) best = v; else best = max(best, v); } return color + best;",
           "float t; while (true) { t = color.r; if (t < 1.0) break; } return color + t;",
       }) {
    const std::string shader = std::string("vec4 apply(vec4 color) { ") + body + " }\n";
    EXPECT_THAT(made(shader).warnings, IsEmpty()) << shader;
  }
  for (const char* body : {
           "float u; for (int i = 0; i < int(color.r); ++i) u = float(i); return color + u;",
           "float u; for (int i = 0; i < 300; ++i) { if (color.r > float(i)) break; u = float(i); } return color + u;",
           "float u; for (int i = 0; i < 300; ++i) { if (color.r > float(i)) continue; u = float(i); } return color + "
           "u;",
           "float u; for (int i = 0; i < 300; ++i) { color += u; u = float(i); } return color;",
           "float u, t; for (int i = 0; i < 300; ++i) { t = u; u = float(i); if (i == 1) color += t; } return color;",
           "float u; for (int i = 0; i < 4; ++i) { float v = color[i]; if (i == 9 || v > u) u = v; } return color + u;",
       }) {
    const std::string shader = std::string("vec4 apply(vec4 color) {\n") + body + " }\n";
    EXPECT_THAT(made(shader).warnings, ElementsAre(read_at(2, "u"))) << shader;
  }
}

/// Which would take too long to follow: nothing is told.
TEST(GiveValues, AmongVeryManyCalls) {
  std::string shader = "float f0(float x) { return x * 0.5; }\n";
  for (int i = 1; i <= 10; ++i)
    shader += "float f" + std::to_string(i) + "(float x) { return f" + std::to_string(i - 1) + "(x) - f" +
              std::to_string(i - 1) + "(x); }\n";
  shader += "vec4 apply(vec4 color) { float a, b; a = 1.0; return color + f10(color.r) * a + b; }\n";
  const Made one = made(shader);
  EXPECT_TRUE(one.warnings.empty());  // a's would be wrong, and nothing tells them apart
  EXPECT_THAT(one.pixel, ElementsAre(0.5f, 0.25f, 2.f, 1.f));
}

TEST(GiveValues, AmongVeryManyVariablesAndBranches) {
  std::string shader = "vec4 apply(vec4 color) { float none;";
  for (int i = 0; i < 400; ++i)
    shader += fmt::format(" float v{0}; if (color.r < {0}.25) v{0} = color.r; else v{0} = color.g;", i);
  shader += " float sum = none;";
  for (int i = 0; i < 400; ++i) shader += fmt::format(" sum += v{};", i);
  const Made one = made(shader + " return vec4(sum); }\n");
  EXPECT_TRUE(one.warnings.empty());
  EXPECT_EQ(one.pixel[0], 0.25f + 399 * 0.5f);
}

TEST(GiveValues, AtEveryTurnOfALoop) {
  // The second turn must not see what the first one left.
  const Made one = made(
      "vec4 apply(vec4 color) {\n  float sum = 0.0;\n  for (int i = 0; i < 3; ++i) {\n    float u;\n"
      "    if (i == 0) u = color.b;\n    sum += u;\n  }\n  return vec4(sum);\n}\n");
  EXPECT_THAT(one.warnings, ElementsAre(read_at(4, "u")));
  EXPECT_THAT(one.pixel, ElementsAre(2.f, 2.f, 2.f, 2.f));
}

TEST(GiveValues, ArraysAndStructs) {
  const Made array = made(
      "vec4 apply(vec4 color) {\n  float a[3], b[2][2];\n  a[1] = color.r;\n  return vec4(a[0], a[1], a[2], b[1][0]);\n"
      "}\n");
  EXPECT_THAT(array.warnings, ElementsAre(read_at(2, "a"), read_at(2, "b")));
  EXPECT_THAT(array.pixel, ElementsAre(0.f, 0.5f, 0.f, 0.f));
  const Made record = made(
      "struct Light { vec3 color; float far[2]; };\nvec4 apply(vec4 color) {\n  struct Local { int n; } local;\n"
      "  Light light;\n  light.color = color.rgb;\n  return vec4(light.color, light.far[1] + float(local.n));\n}\n");
  EXPECT_THAT(record.warnings, ElementsAre(read_at(3, "local"), read_at(4, "light")));
  EXPECT_THAT(record.pixel, ElementsAre(0.5f, 0.25f, 2.f, 0.f));
}

TEST(GiveValues, OutArguments) {
  const Made one = made(
      "void maybe(float x, out float y,\n           out vec2 z) {\n  if (x > 1.0) y = x;\n  z.x = x;\n}\n"
      "vec4 apply(vec4 color) {\n  float a = 7.0, b = 7.0; vec2 c = vec2(7.0), d = vec2(7.0);\n"
      "  maybe(color.b, a, c);\n  maybe(color.r, b, d);\n  return vec4(a, b, c.y, d.x);\n}\n");
  EXPECT_THAT(one.warnings, ElementsAre("1: 'y' may leave its function without a value; it is 0 then",
                                        "2: 'z' may leave its function without a value; it is 0 then"));
  EXPECT_THAT(one.pixel, ElementsAre(2.f, 0.f, 0.f, 0.5f));
}

TEST(GiveValues, FunctionsThatEndWithoutAReturn) {
  const std::string gives_0 = "' may end without a return; it gives 0 then";
  for (const int rows : {1, 8}) {
    const Made one = made("vec4 apply(vec4 color) {\n  if (color.r > 0.7) return color;\n}\n", rows);
    EXPECT_THAT(one.warnings, ElementsAre("1: 'apply" + gives_0));
    EXPECT_THAT(one.pixel, ElementsAre(0.f, 0.f, 0.f, 0.f));
  }
  const Made other = made(
      "struct Two { vec2 a; float b; };\n\nTwo two(float x) {\n  for (int i = 0; i < 3; ++i)\n"
      "    if (x * float(i) > 3.0) return Two(vec2(x), 1.0);\n}\n"
      "vec4 apply(vec4 color) { return vec4(two(color.b).a, two(color.r).a); }\n");
  EXPECT_THAT(other.warnings, ElementsAre("3: 'two" + gives_0));
  EXPECT_THAT(other.pixel, ElementsAre(2.f, 2.f, 0.f, 0.f));
}

TEST(GiveValues, EndsThatNobodyReachesAreNotTold) {
  for (const char* body :
       {"if (color.r > 0.7) return color; else return color;",
        "if (color.r > 0.7) { return color; } else if (color.g > 0.5) { return color; } else { return color; }",
        "switch (int(color.r)) { case 0: return color; default: return color; }", "for (;;) return color;",
        "while (true) { if (color.r < 0.7) return color; color.r -= 1.0; }",
        "do { if (color.r < 0.7) return color; color.r -= 1.0; } while (true);", "{ return color; }",
        "if (color.r < 0.7) { float x = color.r; } return color;"}) {
    const Made one = made(std::string("vec4 apply(vec4 color) { ") + body + " }\n");
    EXPECT_THAT(one.warnings, IsEmpty()) << body;
    EXPECT_THAT(one.pixel, ElementsAre(0.5f, 0.25f, 2.f, 1.f)) << body;
  }
}

TEST(GiveValues, EarlyReturnsHideNothing) {
  const auto made_of = [](const std::string& body) {
    return made("float f(float x, out float y) { " + body +
                " }\nvec4 apply(vec4 color) { float y, x = f(color.b, y); return vec4(x, y, 0.0, 1.0); }\n");
  };
  for (const char* body :
       {"y = x; if (x > 1.0) return 2.0; return 4.0;", "if (x > 1.0) { y = x; return 2.0; } y = x; return 4.0;",
        "if (x > 1.0) { y = x; return 2.0; } else { y = x; } return 4.0;"}) {
    const Made one = made_of(body);
    EXPECT_THAT(one.warnings, IsEmpty()) << body;
    EXPECT_THAT(one.pixel, ElementsAre(2.f, 2.f, 0.f, 1.f)) << body;
  }
  const Made one = made_of("if (x > 1.0) return 2.0; y = x; return 4.0;");
  EXPECT_THAT(one.warnings, ElementsAre("1: 'y' may leave its function without a value; it is 0 then"));
  EXPECT_THAT(one.pixel, ElementsAre(2.f, 0.f, 0.f, 1.f));
  // Out of a loop: the warning is one too many, the value is right.
  const Made loop =
      made_of("for (int i = 0; i < 4; ++i) { if (x > float(i)) { y = x; return 2.0; } } y = x; return 4.0;");
  EXPECT_THAT(loop.pixel, ElementsAre(2.f, 2.f, 0.f, 1.f));
}

TEST(GiveValues, VariablesOfTheFile) {
  for (const int rows : {1, 8}) {
    const Made one = made(
        "float seen, written, given = 3.0;\nvoid keep(float x) { written = x; }\n"
        "vec4 apply(vec4 color) {\n  keep(color.r);\n  return vec4(seen, written, given, 1.0);\n}\n",
        rows);
    EXPECT_THAT(one.warnings, ElementsAre(read_at(1, "seen")));
    EXPECT_THAT(one.pixel, ElementsAre(0.f, 0.5f, 3.f, 1.f));
  }
}

TEST(GiveValues, WhereNoMarkCanStand) {
  const Made one = made(
      "#define HIDDEN float u\nvec4 apply(vec4 color) {\n  HIDDEN;\n  float sum = u;\n"
      "  for (float v; sum < 1.0; sum += 1.0) sum += v;\n  return vec4(sum);\n}\n");
  EXPECT_THAT(one.pixel, ElementsAre(1.f, 1.f, 1.f, 1.f));
}

TEST(GiveValues, NamesThatTheFileUsesTwice) {
  const Made one = made(
      "float u() { return 4.0; }\nvec4 apply(vec4 color) {\n  float v = u();\n  { float u; v += u; }\n"
      "  return vec4(v);\n}\n");
  EXPECT_THAT(one.pixel, ElementsAre(4.f, 4.f, 4.f, 4.f));
}

/// By a zero that the compiler can see: on lavapipe's side of defeat_uniform_inlining, or it would be whatever lay in
/// memory.
TEST(GiveValues, DivisionsAreThoseOfIeee) {
  for (const int rows : {1, 8}) {
    const Made by_zero = made("vec4 apply(vec4 color) { return color / 0.0; }\n", rows);
    for (const float value : by_zero.pixel) EXPECT_TRUE(std::isinf(value) && value > 0);
    const Made of_zero = made("vec4 apply(vec4 color) { return (color - color) / (color - color); }\n", rows);
    for (const float value : of_zero.pixel) EXPECT_TRUE(std::isnan(value));
    for (const char* zeros : {"(color - color) / 0.0", "vec4(0.0) / (color - color)", "0.0 * color / 0.0",
                              "twice(color - color) / (color - color)", "mod(color - color, vec4(0.0))"}) {
      SCOPED_TRACE(zeros);
      const Made made_of = made(fmt::format("vec4 twice(vec4 c) {{ vec4 d = c; if (d.r < 1.0) d *= 2.0; return d; }}\n"
                                            "vec4 apply(vec4 color) {{ return {}; }}\n",
                                            zeros),
                                rows);
      for (const float value : made_of.pixel) EXPECT_TRUE(std::isnan(value)) << value;
    }
    const Made difference = made(
        "vec4 apply(vec4 color) { return vec4(1.0, -1.0, 2.0, 3.0) / vec4(color.r - color.r, 0.0, 2.0, "
        "color.b * 0.0); }\n",
        rows);
    EXPECT_TRUE(std::isinf(difference.pixel[0]) && difference.pixel[0] > 0);
    EXPECT_TRUE(std::isinf(difference.pixel[1]) && difference.pixel[1] < 0);
    EXPECT_EQ(difference.pixel[2], 1.f);
    EXPECT_TRUE(std::isinf(difference.pixel[3]));
  }
}

TEST(GiveValues, WhatIsNoModuleStays) { EXPECT_EQ(give_values({1, 2, 3}), (std::vector<std::uint32_t>{1, 2, 3})); }

}  // namespace
}  // namespace afterglow
