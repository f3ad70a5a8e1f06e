// SPDX-License-Identifier: MIT
// Text that is meant to hurt: it ends in one error, quickly, or compiles; never in a crash.
#include <gmock/gmock.h>

#include <random>

#include "core/file.h"
#include "shader/scan.h"
#include "shader/token.h"
#include "shader_files.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

constexpr const char* kHarmless = "vec4 apply(vec4 color) { return color; }\n";

std::string repeat(const std::string& text, int times) {
  std::string out;
  for (int i = 0; i < times; ++i) out += text;
  return out;
}

std::string outcome(const std::string& text) {
  ShaderFiles files;
  const auto source = files.find("x", text);
  if (!source) return source.error().text();
  KernelCompiler compiler{std::filesystem::path()};
  const auto result = compiler.compile(one({*source, {}, {}}));
  return result.ok() ? "ok" : result.error().text();
}

std::string in_apply(const std::string& text) { return "vec4 apply(vec4 c) {\n" + text + "\nreturn c;\n}\n"; }

TEST(Hostile, NestingIsLimited) {
  EXPECT_THAT(outcome(in_apply(repeat("{", 5000) + repeat("}", 5000))), HasSubstr("nested more than 64 deep"));
  EXPECT_THAT(outcome(in_apply("c *= " + repeat("(", 5000) + "1.0" + repeat(")", 5000) + ";")),
              HasSubstr("nested more than 64 deep"));
  EXPECT_THAT(outcome("#define D " + repeat("(", 5000) + "\n" + kHarmless), HasSubstr("nested more than 64 deep"));
  EXPECT_EQ(outcome(in_apply("c *= " + repeat("(", 60) + "1.0" + repeat(")", 60) + ";")), "ok");
}

TEST(Hostile, LongChainsAreLimited) {
  EXPECT_THAT(outcome(in_apply("c *= 1.0" + repeat(" + 1.0", 20000) + ";")), HasSubstr("statement has more than"));
  EXPECT_THAT(outcome(in_apply("c *= " + repeat("-", 20000) + "1.0;")), HasSubstr("statement has more than"));
  EXPECT_THAT(outcome(in_apply(repeat("if (c.r > 0.0) ", 500) + "c.r = 1.0;")), HasSubstr("without braces"));
  EXPECT_THAT(outcome(in_apply(repeat("for (;;) ", 500) + "c.r = 1.0;")), HasSubstr("without braces"));
  EXPECT_THAT(outcome(in_apply("if (c.r > 0.0) c.r = 1.0;" + repeat(" else if (c.r > 0.0) c.r = 1.0;", 500))),
              HasSubstr("'else' in a row"));
  EXPECT_THAT(outcome(in_apply("if (c.r > 0.0) { c.r = 1.0; }" + repeat(" else if (c.r > 0.0) { c.r = 1.0; }", 500))),
              HasSubstr("'else' in a row"));
  EXPECT_EQ(outcome(in_apply(repeat("if (c.r > 0.0) c.r = 1.0; else c.g = 2.0;\n", 200))), "ok")
      << "one after the other is no chain";
}

TEST(Hostile, ExpressionsAtTheLimitCompile) {
  EXPECT_EQ(outcome(in_apply("float x = 1.0" + repeat(" + c.r", kMaxStatementTokens / 4 - 4) + "; c *= x;")), "ok");
  EXPECT_EQ(outcome(in_apply("float x = " + repeat("- ", kMaxStatementTokens - 64) + "c.r; c *= x;")), "ok");
  EXPECT_EQ(
      outcome(in_apply("float x = " + repeat("c.r > 0.0 ? 1.0 : ", kMaxStatementTokens / 8 - 8) + "2.0; c *= x;")),
      "ok");
}

TEST(Hostile, SizesAreLimited) {
  EXPECT_THAT(outcome(repeat("// some text\n", 30000) + kHarmless), HasSubstr("larger than 262144 bytes"));
  EXPECT_THAT(outcome(repeat("int a;", 30000) + kHarmless), HasSubstr("more than 65536 tokens"));
  EXPECT_THAT(outcome("float " + std::string(2000, 'x') + ";\n" + kHarmless), HasSubstr("longer than 128 characters"));
  EXPECT_THAT(outcome("uniform float a0" +
                      [] {
                        std::string s;
                        for (int i = 1; i < 300; ++i) s += ", a" + std::to_string(i);
                        return s;
                      }() +
                      ";\n" + kHarmless),
              HasSubstr("at most 256 parameters"));
  EXPECT_THAT(outcome([] {
                std::string s;
                for (int i = 0; i < 17; ++i) s += "uniform sampler2D t" + std::to_string(i) + ";\n";
                return s;
              }() + kHarmless),
              HasSubstr("reads at most 16 images"));
}

/// Passes with more loops than a driver compiles in seconds run one by one: joined, they are refused.
TEST(Hostile, LoopsOfJoinedPassesAreFew) {
  ShaderFiles files;
  KernelCompiler compiler{fs::path()};
  const auto looped = [&](const char* name, int calls) {
    std::string text =
        "float f(float v, int n) { for (int i = 0; i < n; ++i) v = v * 1.5 + float(i); return v; }\n"
        "vec4 apply(vec4 color, ivec2 pixel) {\n";
    for (int i = 0; i < calls; ++i) text += fmt::format("  color.r = f(color.r, pixel.x % {});\n", i + 3);
    return files.stage(name, text + "  return color;\n}\n");
  };
  const auto compiles = [&](int first, int second, Fusion fusion) {
    KernelDesc desc = one(looped("t/a", first));
    if (second > 0) desc.stages.push_back(looped("t/b", second));
    desc.config.fusion = fusion;
    return compiler.compile(desc).ok();
  };
  EXPECT_TRUE(compiles(5, 5, Fusion::all));
  EXPECT_FALSE(compiles(6, 5, Fusion::all));
  EXPECT_TRUE(compiles(16, 0, Fusion::all)) << "alone";
  EXPECT_TRUE(compiles(6, 5, Fusion::filters)) << "the way that is left has to do";
}

/// Drivers unfold them, and take minutes, gigabytes or their own death for it.
TEST(Hostile, WhatAShaderHoldsIsLimited) {
  const auto refused = [](const std::string& text, int line, const std::string& name) {
    const std::string said = outcome(text);
    EXPECT_THAT(said, HasSubstr("x.glsl:" + std::to_string(line) + ": error: ")) << said;
    EXPECT_THAT(said, HasSubstr("'" + name + "'")) << said;
    EXPECT_THAT(said, HasSubstr("allowed: at most ")) << said;
  };
  refused(in_apply("int i = int(c.r);\nfloat a[2000000000]; a[i] = 1.0; c.r = a[i + 1];"), 3, "a");
  refused(in_apply("mat4 a[30000][30000]; a[int(c.r)][3] = mat4(c.g); c = a[1][int(c.b)][2];"), 2, "a");
  refused("float many[100000];\nvec4 apply(vec4 c) { many[int(c.r)] = c.g; return vec4(many[int(c.b)]); }\n", 1,
          "many");
  refused(
      "struct S { vec4 far[100]; vec4 more[200]; };\nvec4 apply(vec4 c) {\n  S s;\n  s.more[int(c.r)] = c;\n  return "
      "s.far[1]; }\n",
      3, "s");
  refused("const int kSide = 64;\n#define COUNT (kSide * kSide)\n" +
              in_apply("float a[COUNT]; a[int(c.r)] = 1.0; c.r = a[int(c.g)];"),
          4, "a");
  // Constants have no name behind the compiler; what is handed on has none of its own.
  refused("vec4 few = vec4[2](vec4(1), vec4(2))[0];\nconst float kMany[400] =\n  float[400](0.5" +
              repeat(", 1.0", 399) + ");\n" + in_apply("c.r = kMany[int(c.r)];"),
          3, "an array");
  refused("struct S { float a[300]; };\nS twice(\n  S many) { many.a[1] *= 2.0; return many; }\n" +
              in_apply("S s; s.a[int(c.r)] = 1.0;\nc.r = twice(s).a[int(c.g)];"),
          5, "s");
  // Each by itself is small.
  std::string all, sum;
  for (int i = 0; i < 20; ++i) {
    all += "vec4 a" + std::to_string(i) + "[64]; a" + std::to_string(i) + "[int(c.r)] = c;\n";
    sum += "c += a" + std::to_string(i) + "[int(c.g)];\n";
  }
  EXPECT_THAT(outcome(in_apply(all + sum)), HasSubstr("holds 20480 bytes in arrays"));
  // As many times as they are called.
  std::string calls = "float f0(float x) { float a[64]; a[int(x)] = x; return a[int(x) + 1]; }\n";
  for (int i = 1; i < 40; ++i)
    calls += "float f" + std::to_string(i) + "(float x) { return f" + std::to_string(i - 1) + "(x) + f" +
             std::to_string(i - 1) + "(x + 1.0); }\n";
  EXPECT_THAT(outcome(calls + in_apply("c.r = f39(c.r);")), HasSubstr("in arrays"));
}

TEST(Hostile, WhatAShaderCopiesIsLimited) {
  EXPECT_THAT(outcome("struct S { float a[64]; };\n" +
                      in_apply("S s, t; s.a[int(c.r)] = 1.0;\nt = s; S u = t; S v = u; S w = v; S x = w;\nc.r = "
                               "x.a[int(c.g)];")),
              HasSubstr("copies arrays of 1280 bytes as a whole"));
  EXPECT_EQ(outcome("struct S { float a[8]; };\nS twice(S s) { s.a[1] *= 2.0; return s; }\n" +
                    in_apply("S s; s.a[int(c.r)] = 1.0; c.r = twice(s).a[int(c.g)];")),
            "ok");
}

TEST(Hostile, CallsThatMultiplyAreLimited) {
  std::string calls = "float f0(float x) { return sin(x); }\n";
  for (int i = 1; i < 70; ++i)
    calls += "float f" + std::to_string(i) + "(float x) { return f" + std::to_string(i - 1) + "(x) + f" +
             std::to_string(i - 1) + "(x + 1.0); }\n";
  const std::string said = outcome(calls + in_apply("c.r = f69(c.r);"));
  EXPECT_THAT(said, testing::ContainsRegex(
                        "x.glsl:1[0-9]: error: 'f1[0-9]' comes to [0-9]+ instructions with all that it calls; "
                        "allowed: at most 65536"));
}

TEST(Hostile, MacrosThatExplodeAreRefused) {
  std::string object = "#define M0 1.0 + 1.0\n", function = "#define F0(x) x + x\n";
  for (int i = 1; i < 40; ++i) {
    object += "#define M" + std::to_string(i) + " M" + std::to_string(i - 1) + " + M" + std::to_string(i - 1) + "\n";
    function +=
        "#define F" + std::to_string(i) + "(x) F" + std::to_string(i - 1) + "(x) + F" + std::to_string(i - 1) + "(x)\n";
  }
  EXPECT_THAT(outcome(object + in_apply("c *= M39;")), HasSubstr("macros expand to more than"));
  EXPECT_THAT(outcome(function + in_apply("c *= F39(1.0);")), HasSubstr("macros expand to more than"));
  EXPECT_THAT(
      outcome("#define D(x) ((x) + (x))\n" + in_apply("c *= " + repeat("D(", 40) + "1.0" + repeat(")", 40) + ";")),
      HasSubstr("macros expand to more than"));
  EXPECT_EQ(outcome("#define D(x) ((x) + (x))\n#define E D(2.0) * D(3.0)\n" + in_apply("c *= D(D(D(1.0))) * E;")),
            "ok");
  EXPECT_EQ(outcome("#define A B\n#define B A\nconst float A = 1.0;\n" + in_apply("c *= A;")), "ok")
      << "a macro is not expanded within itself";
}

TEST(Hostile, MacrosWhoseGrowthIsHiddenAreRefused) {
  EXPECT_THAT(outcome("#define OPEN (\n" + std::string(kHarmless)),
              HasSubstr(":1: error: the brackets in macro 'OPEN' are not balanced"));
  EXPECT_THAT(outcome("#define CLOSE )(\n" + std::string(kHarmless)),
              HasSubstr("the brackets in macro 'CLOSE' are not balanced"));
  EXPECT_THAT(outcome("#define F(x) x x\n#define G F\n" + in_apply("c *= G(1.0);")),
              HasSubstr(":2: error: macro 'F' needs its arguments behind it"));
  EXPECT_THAT(outcome("#define F(x) x x\n#define NONE\n" + in_apply("c *= F NONE (1.0);")),
              HasSubstr(":4: error: macro 'F' needs its arguments behind it"));
  EXPECT_THAT(outcome("#define F(x) x\n#define F 1\n" + in_apply("c *= F(1.0);")),
              HasSubstr("both with and without arguments"));
  ShaderFiles files;
  files.write("lib/grow.glsl", "#define GROW(x) x + x\n");
  const auto source = files.find(
      "a", "#include \"lib/grow.glsl\"\n" + in_apply("c *= " + repeat("GROW(", 30) + "1.0" + repeat(")", 30) + ";"));
  ASSERT_FALSE(source.ok());
  EXPECT_THAT(source.error().message, HasSubstr("macros expand to more than"));
}

TEST(Hostile, NamesOfMacrosWithoutArgumentsAreNames) {
  const std::string square = "#define SQ(x) ((x) * (x))\n";
  EXPECT_EQ(outcome(square + "#if defined(SQ) && defined ( SQ )\n#define K 0.5\n#endif\n" + in_apply("c *= SQ(K);")),
            "ok");
  EXPECT_EQ(outcome(square + "#if !defined SQ || !defined(SQ)\n#error no SQ\n#endif\n" + in_apply("c *= SQ(2.0);")),
            "ok");
  EXPECT_EQ(outcome("struct Noise { float fbm, SQ; };\n" + square + "#define fbm(p) SQ(p)\n" +
                    in_apply("Noise n = Noise(1.0, 2.0); n.fbm += n.SQ; c *= fbm(n.fbm + 1.0) + (n.SQ);")),
            "ok");
  EXPECT_EQ(outcome(square + "#define fbm(p) fract(p)\nstruct Noise { float fbm; };\n" +
                    in_apply("Noise n = Noise(1.0); c *= SQ(n.fbm) + fbm(c.r + n.fbm);")),
            "ok");
  EXPECT_EQ(outcome(square + "float f(float SQ) { return SQ; }\n" + in_apply("float SQ = SQ(2.0); c *= f(1.0) + SQ;")),
            "ok");
}

TEST(Hostile, NamesOfMacrosThatMayGetArgumentsLaterAreRefused) {
  const std::string twice = "#define F(x) x + x\n#define NONE\n";
  const std::string why = "macro 'F' needs its arguments behind it";
  EXPECT_THAT(outcome(twice + "#define CALL(f) f(1.0)\n" + in_apply("c *= CALL(F);")), HasSubstr(":5: error: " + why));
  EXPECT_THAT(outcome(twice + "#define CALL(f) f(1.0)\n" + in_apply("c *= CALL(F NONE);")), HasSubstr(why));
  EXPECT_THAT(outcome(twice + "#define CALL(f) (f NONE (1.0))\n" + in_apply("c *= CALL(F);")), HasSubstr(why));
  EXPECT_THAT(outcome(twice + "#define SAME(f, g) (f g)\n" + in_apply("c *= SAME(F, (1.0));")), HasSubstr(why));
  EXPECT_THAT(outcome(twice + "#define CALL(f) f(1.0)\n#define PASS(f) (CALL(f))\n" + in_apply("c *= PASS(F);")),
              HasSubstr(why));
  EXPECT_THAT(outcome(twice + "#define G(x) F x\n" + in_apply("c *= G((1.0));")), HasSubstr(":3: error: " + why));
  EXPECT_THAT(outcome(twice + "#define G defined F\n" + in_apply("c *= G(1.0);")), HasSubstr(why));
  std::string function = "#define F0(x) x + x\n";
  for (int i = 1; i < 40; ++i)
    function +=
        "#define F" + std::to_string(i) + "(x) F" + std::to_string(i - 1) + "(x) + F" + std::to_string(i - 1) + "(x)\n";
  EXPECT_THAT(outcome(function + "float defined(float x) { return x; }\n" + in_apply("c *= defined(F39(1.0));")),
              HasSubstr("macros expand to more than"));
}

TEST(Hostile, IncludesAreLimited) {
  ShaderFiles files;
  for (int i = 0; i < 100; ++i)
    files.write("lib/deep" + std::to_string(i) + ".glsl", "#include \"lib/deep" + std::to_string(i + 1) + ".glsl\"\n");
  EXPECT_THAT(files.find("a", std::string("#include \"lib/deep0.glsl\"\n") + kHarmless).error().text(),
              HasSubstr("nested more than 16 deep"));
  std::string many;
  for (int i = 0; i < 100; ++i) {
    files.write("lib/wide" + std::to_string(i) + ".glsl", "");
    many += "#include \"lib/wide" + std::to_string(i) + ".glsl\"\n";
  }
  EXPECT_THAT(files.find("b", many + kHarmless).error().text(), HasSubstr("includes at most 64 files"));
}

TEST(Hostile, AFolderIsNoShader) {
  ShaderFiles files;
  std::filesystem::create_directories(files.path("a.glsl"));
  EXPECT_THAT(ShaderLibrary(files.search()).find("a").error().text(), HasSubstr("unknown shader 'a'"));
}

/// Random edits of real shaders: whatever comes out, the process lives and errors have a message.
TEST(Hostile, RandomEditsOfRealShaders) {
  SearchPath search;
  search.installation = AFTERGLOW_PROJECT_FOLDER;
  ShaderLibrary library(search);
  std::vector<std::string> texts = {
      "#define A(x) x\n#if 1\nuniform float t;\n#endif\nlayout(constant_id = 0) const int n = 1;\nstruct S { float "
      "a[2]; };\n"
      "vec4 apply(vec4 c, vec4 h) { S s; return A(c) * t + h * s.a[n]; }\n"};
  for (const auto& name : library.names())
    if (const auto source = library.find(name); source.ok()) texts.push_back((*source)->file->text);
  const std::string tokens[] = {"(",
                                ")",
                                "{",
                                "}",
                                "[",
                                ";",
                                ",",
                                "#",
                                "\n#if ",
                                "\n#endif\n",
                                "\"",
                                "/*",
                                "*/",
                                "//",
                                "\\\n",
                                "uniform ",
                                "struct ",
                                "layout(",
                                "const ",
                                "apply",
                                "vec4 ",
                                "ag_",
                                "\n#define X ",
                                "X",
                                "0x",
                                "1e",
                                ".",
                                "\r",
                                "\xff",
                                std::string(1, '\0'),
                                "sampler2D ",
                                "constant_id=",
                                "\n#include \"lib/color.glsl\"\n",
                                "-",
                                "?",
                                ":"};
  std::mt19937 random(2024);
  ShaderFiles files;
  files.write("lib/color.glsl", read_file(search.installation / "shaders/lib/color.glsl").value());
  KernelCompiler compiler{std::filesystem::path()};
  int refused = 0;
  for (int round = 0; round < 1500; ++round) {
    std::string text = texts[random() % texts.size()];
    for (unsigned edits = 1 + random() % 4; edits > 0; --edits) {
      const std::size_t at = random() % (text.size() + 1);
      switch (random() % 4) {
        case 0:
          text.insert(at, tokens[random() % std::size(tokens)]);
          break;
        case 1:
          text.erase(at, random() % 12);
          break;
        case 2:
          text.insert(at, text.substr(random() % (text.size() + 1), random() % 60));
          break;
        default:
          text.resize(std::max<std::size_t>(at, 1));
          break;
      }
    }
    const auto source = files.find("fuzz", text);
    if (!source) {
      EXPECT_EQ(source.error().kind, ErrorKind::script) << source.error().text();
      EXPECT_FALSE(source.error().message.empty());
      ++refused;
      continue;
    }
    const auto result = compiler.compile(one({*source, {}, {}}));
    if (!result.ok()) {
      EXPECT_EQ(result.error().kind, ErrorKind::script) << result.error().text() << "\n" << text;
      EXPECT_FALSE(result.error().message.empty());
      ++refused;
    }
  }
  EXPECT_GT(refused, 300);
  EXPECT_LT(refused, 1500) << "some edits are harmless";
}

}  // namespace
}  // namespace afterglow
