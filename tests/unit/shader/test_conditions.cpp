// SPDX-License-Identifier: MIT
// Branches that a file's preprocessor lines leave out: the same as the compiler's, or left to it.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <functional>
#include <random>

#include "shader/glsl.h"
#include "shader/token.h"
#include "shader_files.h"

namespace afterglow {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// The words outside of the preprocessor's lines.
std::vector<std::string> words(const std::string& text) {
  const auto tokens = tokenize(text, "f.glsl");
  if (!tokens) return {tokens.error().text()};
  std::vector<std::string> out;
  for (const Token& token : tokens->tokens)
    if (token.directive < 0) out.emplace_back(token.text);
  return out;
}

/// The preprocessor's lines that stay.
std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> out;
  const auto tokens = tokenize(text, "f.glsl");
  if (!tokens) return {tokens.error().text()};
  int line = -1;
  for (const Token& token : tokens->tokens) {
    if (token.directive < 0) continue;
    if (token.directive != line) out.emplace_back();
    line = token.directive;
    out.back() += std::string(token.text) + " ";
  }
  return out;
}

TEST(Conditions, WhatIsKnownIsDecided) {
  EXPECT_THAT(words("#if 0\na\n#else\nb\n#endif\nc\n"), ElementsAre("b", "c"));
  EXPECT_THAT(words("#if 1\na\n#else\nb\n#endif\nc"), ElementsAre("a", "c"));
  EXPECT_THAT(words("#define A\n#ifdef A\na\n#endif\n#ifndef A\nb\n#endif\n#undef A\n#ifdef A\nc\n#endif\n"),
              ElementsAre("a"));
  EXPECT_THAT(words("#define N 3\n#if N == 1\na\n#elif N == 2\nb\n#elif N == 3\nc\n#elif N == 3\nd\n#else\ne\n#endif"),
              ElementsAre("c"));
  EXPECT_THAT(words("#define N (1 + 2)\n#define M N * 2\n#if M == 6 && !defined(K) && defined N\na\n#endif\n"),
              ElementsAre("a"));
  EXPECT_THAT(words("#ifdef GL_ES\na\n#else\nb\n#endif\n"), ElementsAre("b"));
  EXPECT_THAT(
      lines("#if 1 // so\n#define A\n# /* ! */ if 0\n#define B\n#include \"x\"\n#else\n#define C\n#endif\n#endif"),
      ElementsAre("# define A ", "# define C "));
}

TEST(Conditions, WhatIsNotKnownStays) {
  const auto stays = [](const std::string& condition) {
    EXPECT_THAT(words("#define F(x) x\n#define G\n" + condition + "\na\n#else\nb\n#endif\n"), ElementsAre("a", "b"))
        << condition;
  };
  for (const char* condition : {"#ifdef GL_EXT_control_flow_attributes",
                                "#if __VERSION__ > 300",
                                "#ifdef VULKAN",
                                "#if F(1)",
                                "#if UNKNOWN",
                                "#if 1 / 0",
                                "#if 2147483647 + 1",
                                "#if 1 << 40",
                                "#if",
                                "#if (1",
                                "#if 1)",
                                "#if 1 1",
                                "#if 1.0",
                                "#if 3u",
                                "#if G",
                                "#if -G 1 &",
                                "#if defined",
                                "#if defined(F",
                                "#ifdef",
                                "#ifdef F F",
                                "#if 08",
                                "#if & & 1",
                                "#if 1++1",
                                "#if --1"})
    stays(condition);
  // An include may define it.
  EXPECT_THAT(words("#include \"lib/a.glsl\"\n#ifdef A\na\n#else\nb\n#endif\n"), ElementsAre("a", "b"));
  // A branch that may be left out defines it.
  EXPECT_THAT(words("#ifdef VULKAN\n#define A\n#ifdef A\na\n#endif\n#endif\n#ifdef A\nb\n#else\nc\n#endif\n"),
              ElementsAre("a", "b", "c"));
  EXPECT_THAT(words("#define A 1\n#ifdef VULKAN\n#if A\na\n#else\nb\n#endif\n#endif"), ElementsAre("a"));
  EXPECT_THAT(lines("#if 0\na\n#elif 0\nb\n#elif defined(VULKAN)\nc\n#elif 1\nd\n#else\ne\n#endif\n"),
              ElementsAre("# if defined ( VULKAN ) ", "# elif 1 ", "# else ", "# endif "));
  EXPECT_THAT(words("#if 0\na\n#elif 0\nb\n#elif defined(VULKAN)\nc\n#elif 1\nd\n#else\ne\n#endif\n"),
              ElementsAre("c", "d", "e"));
}

TEST(Conditions, WhatIsLeftOutNeedNotBeGlsl) {
  EXPECT_THAT(words("#if 0\nthis isn't GLSL ( [ { \" \\ @\n#bad\n  # \\\n  if 1\n/* #endif */ // #else\n#endif /* \n"
                    "#endif\n*/ #endif no\n#else\n#endif\nb\n"),
              ElementsAre("b"));
  EXPECT_THAT(words("#if 0\n#if 1\na\n#elif 1\n#else\nb\n#endif\n#else\nc\n#endif\n"), ElementsAre("c"));
}

TEST(Conditions, MessagesNameTheLine) {
  EXPECT_THAT(words("\n#if 0\n\n#if 1\n#endif\n"), ElementsAre(HasSubstr("f.glsl:2: error: #if is never closed")));
  EXPECT_THAT(words("#if 1\n#else\n#else\n#endif\n"), ElementsAre(HasSubstr("f.glsl:3: error: #else behind #else")));
  EXPECT_THAT(words("#if X\n#else\n#elif 1\n#endif\n"), ElementsAre(HasSubstr("f.glsl:3: error: #elif behind #else")));
  EXPECT_THAT(words("#if 0\n\n/* a\n\n*/\n\\\n\n#endif\n@"), ElementsAre(HasSubstr("f.glsl:9: error: unexpected")));
  EXPECT_THAT(words("#if 0\n/* a\n"), ElementsAre(HasSubstr("f.glsl:2: error: the comment is never closed")));
}

TEST(Conditions, MacrosThatGrowAreLeftToTheCheckOfMacros) {
  std::string text = "#define A0 1 + 1\n";
  for (int i = 1; i < 60; ++i) text += fmt::format("#define A{0} A{1} + A{1}\n", i, i - 1);
  EXPECT_THAT(words(text + "#if A59\na\n#endif"), ElementsAre("a"));
  std::string nothing = "#define N0\n";
  for (int i = 1; i < 60; ++i) nothing += fmt::format("#define N{0} N{1} N{1}\n", i, i - 1);
  EXPECT_THAT(words(nothing + "#if N59 1\na\n#else\nb\n#endif"), ElementsAre("a", "b"));
  EXPECT_THAT(words("#define U\n#undef U\n#if U 1\na\n#else\nb\n#endif"), ElementsAre("a", "b"));
  std::string deep = "#define B0 0\n";
  for (int i = 1; i < 2000; ++i) deep += fmt::format("#define B{0} B{1}\n", i, i - 1);
  EXPECT_THAT(words(deep + "#if B1999\na\n#endif"), ElementsAre("a"));
  EXPECT_THAT(words("#if " + std::string(50000, '!') + "1\na\n#endif"), ElementsAre("a"));
  EXPECT_THAT(words("#if " + std::string(1, '!') + std::string(60, '(') + "1" + std::string(60, ')') + "\na\n#endif"),
              IsEmpty());
  EXPECT_THAT(words("#define A A\n#if A\na\n#endif"), ElementsAre("a"));
}

/// The compiler's word for it: which of two errors it comes to; nothing when it has another one.
std::string of_compiler(const std::string& before, const std::string& condition) {
  const auto made = compile_glsl(
      "#version 460\n" + before + condition + "\n#error first\n#else\n#error second\n#endif\n", {"f.glsl"});
  if (made) return "";
  const std::string text = made.error().text();
  return text.find("first") != text.npos ? "first" : text.find("second") != text.npos ? "second" : "";
}

TEST(Conditions, TheyAreThoseOfTheCompiler) {
  std::mt19937 random(7);
  const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const auto one_of = [&](const std::vector<std::string>& of) {
    return of[static_cast<std::size_t>(pick(static_cast<int>(of.size())))];
  };
  const std::string before = "#define A 3\n#define B (A - 5)\n#define C A + 1\n#define E\n";
  const std::function<std::string(int)> made = [&](int depth) -> std::string {
    if (depth == 0 || pick(5) == 0)
      return one_of({"0", "1", "2", "0x1f", "017", "A", "B", "C", "defined(A)", "defined E", "defined(D)"});
    if (pick(4) == 0) return one_of({"!", "-", "~", "+", "- -", "! !"}) + made(depth - 1);
    if (pick(3) == 0) return "(" + made(depth - 1) + ")";
    return made(depth - 1) +
           one_of({" && ", "||", "==", " != ", "<", " <= ", ">", ">=", "+", " - ", "*", "/", "%", "&", "|", "^", "<<",
                   " >> "}) +
           made(depth - 1);
  };
  int known = 0;
  for (int i = 0; i < 1500; ++i) {
    const std::string condition = "#if " + made(3);
    const auto ours = words(before + condition + "\nfirst\n#else\nsecond\n#endif\n");
    ASSERT_FALSE(ours.empty()) << condition;
    if (ours.size() > 1) continue;
    ++known;
    EXPECT_EQ(ours[0], of_compiler(before, condition)) << condition;
  }
  EXPECT_GT(known, 700);
}

TEST(Conditions, ShadersThatChooseTheirFunctions) {
  const ShaderFiles files;
  const auto outcome = [&](const std::string& text) {
    KernelDesc kernel;
    kernel.stages = {files.stage("a", text), files.stage("b", text)};
    const auto made = KernelCompiler({}).compile(kernel);
    return made ? "ok" : made.error().text();
  };
  const std::string fast = "#define FAST 1\n";
  EXPECT_EQ(outcome(fast + "#if FAST\nvec4 apply(vec4 color) {\n#else\nvec4 apply(vec4 color, ivec2 pixel) {\n#endif\n"
                           "  return color;\n}\n"),
            "ok");
  EXPECT_EQ(outcome(fast + "vec4 apply(vec4 color) {\n#if FAST > 1\n  if (color.r > 0.5) {\n#else\n  {\n#endif\n"
                           "    color.r = 1.0; }\n  return color;\n}\n"),
            "ok");
  EXPECT_EQ(
      outcome("#ifdef SLOW\nuniform float far;\n#define f(x) far * x\n#else\nfloat f(float x) { return x; }\n#endif\n"
              "vec4 apply(vec4 color) { return color * f(2.0); }\n"),
      "ok");
  EXPECT_EQ(outcome("#if 0\nvoid main() { gl_FragColor = dFdx(discard); ag_x(\n#endif\nvec4 apply(vec4 color) { return "
                    "color; }\n"),
            "ok");
  EXPECT_EQ(outcome("#if 0\n#elif defined(VULKAN)\n#define K 1.0\n#else\n#define K other\n#endif\n"
                    "vec4 apply(vec4 color) { return color * K; }\n"),
            "ok");
  // Lines stay where they are.
  EXPECT_THAT(
      outcome("#if 0\n{ { {\n#else // so\n#define A \\\n 2.0\n#endif\nvec4 apply(vec4 color) { return nothing; }\n"),
      StartsWith(files.path("a.glsl").string() + ":7: error: 'nothing'"));
}

}  // namespace
}  // namespace afterglow
