// SPDX-License-Identifier: MIT
// Loops that never end, and loops that look like it: the first are told by file and line, the others keep their bits.
#include <gmock/gmock.h>

#include <cstring>
#include <spirv-tools/libspirv.hpp>

#include "exec/renderer.h"
#include "shader/kernel.h"
#include "workshop.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

class EndlessLoops : public Workshop {
 protected:
  void SetUp() override {
    Workshop::SetUp();
    shader("copy", "uniform sampler2D source;\nvec4 sample_at(ivec2 pixel) { return fetch(source, pixel); }\n");
  }
  /// What the shader makes of noise, or what is said about it.
  std::string outcome(const std::string& text, std::vector<float>* pixels = nullptr, Size size = {64, 64},
                      std::map<std::string, ParamValue> params = {}) {
    const std::string name = "loop" + std::to_string(++shaders_);
    shader(name, text);
    GraphBuilder builder(size);
    const bool by_groups = text.find("compute_at") != std::string::npos;
    ImageId made = builder.sample("pass", name, size, {{"source", builder.source()}}, params);
    if (by_groups) made = builder.sample("copy", "copy", size, {{"source", made}});
    Graph graph = builder.finish(made);
    if (by_groups) graph.passes[0].kind = PassKind::compute;
    auto program = try_program(graph);
    if (!program) return program.error().text();
    const std::vector<float> source = noise(size, 7);
    auto runner = FrameRunner::create(device(), 6ull << 30);
    EXPECT_TRUE(runner);
    HostResult out;
    const auto run = [&] {
      return (*runner)->run(**program, {{"source", {.pixels = source.data(), .size = size}}}, out, KernelTiming::none);
    };
    const auto first = run();
    if (first && pixels) *pixels = out.pixels;
    const auto again = run();  // what was told once is told again, and does not stay
    EXPECT_EQ(first.ok(), again.ok());
    return first ? "ok" : first.error().text();
  }
  static std::string sample(const std::string& body, const std::string& before = "") {
    return "uniform sampler2D source;\n" + before +
           "vec4 sample_at(ivec2 pixel) {\n  vec4 c = fetch(source, pixel);\n" + body + "\n  return c;\n}\n";
  }
  int shaders_ = 0;
};

TEST_F(EndlessLoops, AreToldByFileAndLine) {
  const auto endless = [&](const std::string& text, int line) {
    const std::string said = outcome(text);
    EXPECT_THAT(said, HasSubstr(".glsl:" + std::to_string(line) + ": error: a loop did not end within 32768 turns"))
        << text;
  };
  endless(sample("while (true) c.r += 1.0;"), 4);
  endless(sample("c.g = 1.0;\nfor (;;) {\n  c.r = sin(c.r);\n  if (c.r > 2.0) return c;\n}"), 5);
  endless(sample("do c.r += 0.5; while (c.r > -1.0);"), 4);
  endless(sample("for (float x = 0.0; x < 1.0; x += c.g * 1e-30) c.b += x;"), 4);
  endless(sample("for (int i = 0; i < 1000000; ++i) c.r += float(i);"), 4);
  endless(sample("for (int i = 0; i < int(c.r) + 40000; ++i) c.r += float(i);"), 4);
  endless(sample("for (int i = 2147483646; i <= 2147483647; ++i) c.r += 1.0;"), 4);
  endless(sample("for (int i = 0; i > -2147483647 - 1 + image_size(source).x * 0; i -= 3) c.r += 1.0;"), 4);
  endless(sample("for (int i = 0; i < 300; ++i)\n  for (int j = 0; j < image_size(source).x * 9; ++j) c.r += 1.0;"), 5);
  endless(sample("c = f(c);", "vec4 f(vec4 v) {\n  while (v.r > -1.0) {\n    v.r += 1.0;\n  }\n  return v;\n}\n"), 3);
  endless(sample("for (int i = 0; i < image_size(source).x; ++i) {\n  for (int j = 0; j < 1000; ++j) c.r += 1.0;\n}"),
          4);
  endless(
      "uniform sampler2D source;\nlayout(local_size_x = 8, local_size_y = 8) in;\nvec4 compute_at(ivec2 pixel) {\n"
      "  vec4 c = fetch(source, pixel);\n  while (c.a > -1.0) c.a += 1.0;\n  return c;\n}\n",
      5);
}

/// Which loops run out depends neither on what a pass is fused with nor on how many rows are drawn at a time.
TEST_F(EndlessLoops, EachPassHasAllTurns) {
  const Size size{64, 64};
  shader("turns",
         "uniform int count;\nvec4 apply(vec4 c) {\n  for (int i = 0; i < count; ++i) c.r = fract(c.r * 1.5 + c.g);\n"
         "  return c;\n}\n");
  const std::vector<float> source = noise(size, 7);
  const auto made = [&](int second, const ExecutionConfig& config) -> Result<std::vector<float>> {
    GraphBuilder builder(size);
    const ImageId first =
        builder.pixel("first", "turns", builder.source(), {}, {{"count", ParamValue{ParamType::int1, {20000}}}});
    const Graph graph = builder.finish(builder.pixel(
        "second", "turns", first, {}, {{"count", ParamValue{ParamType::int1, {static_cast<double>(second)}}}}));
    AFTERGLOW_TRY(const auto program, try_program(graph, {.config = config, .result_by_rows = true}));
    EXPECT_EQ(program->plan().kernels.size(), config.fusion == Fusion::all ? 1u : 2u);
    AFTERGLOW_TRY(const auto runner, FrameRunner::create(device(), 6ull << 30));
    HostResult out;
    AFTERGLOW_CHECK(
        runner->run(*program, {{"source", {.pixels = source.data(), .size = size}}}, out, KernelTiming::none));
    return out.pixels;
  };
  const auto apart = made(30000, {.fusion = Fusion::none});
  ASSERT_TRUE(apart) << apart.error().text();
  for (const int rows : {1, 4}) {
    const auto fused = made(30000, {.rows = rows});
    ASSERT_TRUE(fused) << fused.error().text();
    EXPECT_EQ(*fused, *apart) << rows << " rows";
    const auto too_many = made(40000, {.rows = rows});
    ASSERT_FALSE(too_many) << rows << " rows";
    EXPECT_THAT(too_many.error().text(), HasSubstr("within 32768 turns"));
  }
}

/// A warm-up draws pixels of images that nobody has filled: a loop that ends by what it reads may not end there, which
/// is no fault of the frame behind it.
TEST_F(EndlessLoops, AWarmUpTellsNothing) {
  const Size size{64, 64};
  shader("sum", sample("float at = 0.0;\nwhile (!(at >= 10.0)) at += c.a;\nc.r = at;"));
  GraphBuilder builder(size);
  const Graph graph = builder.finish(builder.sample("pass", "sum", size, {{"source", builder.source()}}));
  for (const bool dispatched : {false, true}) {
    const auto made =
        program(graph, {.config = {.dispatched = dispatched}, .inputs_are_storage = true, .result_stored = true});
    ASSERT_TRUE(made);
    const auto runner = FrameRunner::create(device(), 6ull << 30);
    ASSERT_TRUE(runner);
    ASSERT_TRUE((*runner)->warm_up(*made));
    const std::vector<float> source(static_cast<std::size_t>(size.area()) * 4, 0.5f);
    HostResult out;
    const auto done =
        (*runner)->run(*made, {{"source", {.pixels = source.data(), .size = size}}}, out, KernelTiming::none);
    ASSERT_TRUE(done) << done.error().text();
    EXPECT_EQ(out.pixels[0], 10);
  }
}

/// Workgroups are whole, regions need not be: what stands in a group beside a region reads what is made.
TEST_F(EndlessLoops, RegionsReadNothingThatIsNotMade) {
  const Size size{101, 57};
  shader("half", "uniform sampler2D source;\nvec4 sample_at(ivec2 p) { return 0.5 * fetch(source, p); }\n");
  shader("drawn", sample("float at = 0.0;\nwhile (!(at >= 10.0)) at += c.a;\nc.r = at;"));
  shader("grouped",
         "layout(local_size_x = 8, local_size_y = 8) in;\nuniform sampler2D source;\nvec4 compute_at(ivec2 pixel) {\n"
         "  vec4 c = fetch(source, pixel);\n  float at = 0.0;\n  while (!(at >= 10.0)) at += c.a;\n  c.r = at;\n"
         "  return c;\n}\n");
  for (const char* way : {"drawn", "dispatched", "grouped"}) {
    const bool grouped = std::string(way) == "grouped";
    GraphBuilder builder(size);
    const ImageId half = builder.sample("half", "half", size, {{"source", builder.source()}});
    ImageId made = builder.sample("loop", grouped ? "grouped" : "drawn", size, {{"source", half}});
    if (grouped) made = builder.sample("copy", "copy", size, {{"source", made}});
    Graph graph = builder.finish(made);
    if (grouped) graph.passes[1].kind = PassKind::compute;
    for (Pass& pass : graph.passes) pass.reach = 0;
    const std::vector<float> source(static_cast<std::size_t>(size.area()) * 4, 1.0f);
    const Rect part{37, 21, 30, 9};
    const auto out = run(graph, {{"source", {.pixels = source.data(), .size = size}}},
                         {.config = {.fusion = Fusion::none, .dispatched = std::string(way) == "dispatched"},
                          .inputs_are_storage = true,
                          .result_stored = true,
                          .region = part});
    ASSERT_FALSE(out.pixels.empty()) << way;
    const auto at = [&](int x, int y) { return out.pixels[static_cast<std::size_t>(y * size.width + x) * 4]; };
    EXPECT_EQ(at(part.x, part.y), 10) << way;
    EXPECT_EQ(at(part.x + part.width - 1, part.y + part.height - 1), 10) << way;
  }
}

/// Invocations that turned other loops more often than others do not leave one with a barrier alone: the others would
/// wait for them for ever.
TEST_F(EndlessLoops, WorkgroupsLeaveLoopsWithBarriersTogether) {
  const std::string text =
      "uniform sampler2D source;\nuniform float turns;\nlayout(local_size_x = 8, local_size_y = 8) in;\n"
      "shared float highest;\nvoid wait() {\n  barrier();\n}\n"
      "vec4 compute_at(ivec2 pixel) {\n  vec4 c = fetch(source, pixel);\n  float own = 0.0;\n"
      "  while (own < 1000.0 * float(pixel.x)) own += 1.0;\n"
      "  for (float left = turns; left > 0.5; left -= 1.0) wait();\n"
      "  for (int i = 0; i < int(turns); ++i) barrier();\n  return vec4(own);\n}\n";
  const Size group{8, 8};
  std::vector<float> pixels;
  EXPECT_EQ(outcome(text, &pixels, group, {{"turns", number(30000)}}), "ok");
  ASSERT_EQ(pixels.size(), 256u);
  EXPECT_EQ(pixels[0], 0);
  EXPECT_EQ(pixels[std::size_t{4} * 7], 7000);
  EXPECT_THAT(outcome(text, nullptr, group, {{"turns", number(40000)}}),
              HasSubstr(".glsl:12: error: a loop did not end"));

  KernelDesc desc;
  desc.sample = KernelStage{.shader = *library_->find("loop1"), .constants = {}, .label = "s"};
  desc.config.guard_loops = true;
  const auto kernel = compiler_->compile(desc);
  ASSERT_TRUE(kernel) << kernel.error().text();
  EXPECT_TRUE(spvtools::SpirvTools(SPV_ENV_VULKAN_1_1).Validate(kernel->spirv));
  EXPECT_GE(kernel->shared_bytes, 8u) << "of the shader, and of the guard";
}

/// The first pixel that runs out of turns ends the frame: one by one, these would take hours.
TEST_F(EndlessLoops, EndTheirFrame) {
  EXPECT_THAT(outcome(sample("for (;;) for (int i = 0; i < 4000; ++i) c = sin(c) + cos(c.bgra * float(i));"), nullptr,
                      {512, 512}),
              HasSubstr("did not end"));
}

/// A loop that ends keeps its bits, whatever its guard.
TEST_F(EndlessLoops, LoopsThatEndKeepTheirBits) {
  const auto same = [&](const std::string& guarded, const std::string& plain,
                        const std::map<std::string, ParamValue>& params = {}) {
    std::vector<float> a, b;
    EXPECT_EQ(outcome(guarded, &a, {37, 21}, params), "ok") << guarded;
    EXPECT_EQ(outcome(plain, &b, {37, 21}), "ok") << plain;
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0) << guarded;
  };
  const std::string add = "c = c * 0.5 + fetch(source, pixel + ivec2(i, 0));";
  const std::string five = sample("for (int i = 0; i < 5; ++i) " + add);
  const std::string down = sample("for (int i = 4; i >= 0; --i) " + add);
  const std::map<std::string, ParamValue> n{{"n", number(5)}}, last{{"n", number(4)}};
  same(sample("for (int i = 0; i < n; ++i) " + add, "uniform int n;\n"), five, n);
  same(sample("for (int i = 0; i <= n; ++i) " + add, "uniform int n;\n"), five, last);
  same(sample("for (int i = n - 1; i >= 0; --i) " + add, "uniform int n;\n"), down, n);
  same(sample("for (int i = n; i > -1; i -= 1) " + add, "uniform int n;\n"), down, last);
  same(sample("int i = 0; while (i < n) { " + add + " ++i; }", "uniform int n;\n"), five, n);
  same(sample("int i = 0; for (;;) { if (i == n) break; " + add + " ++i; }", "uniform int n;\n"), five, n);
  same(sample("int i = 0; do { " + add + " } while (++i < n);", "uniform int n;\n"), five, n);
  same(sample("for (int i = 0; i < n; ++i) { if (i == 7) continue; " + add + " if (i == 4) return c; }",
              "uniform int n;\n"),
       five, {{"n", number(50)}});
  same(sample("for (int i = 9; i < n; ++i) " + add, "uniform int n;\n"), sample(""), n);
  same(sample("for (int i = 0; i < n; i += 3) " + add, "uniform int n;\n"),
       sample("for (int i = 0; i < 6; i += 3) " + add), n);
  // The bound moves: not a loop that counts.
  same(sample("int m = 9; for (int i = 0; i < m; ++i) { m -= n - 4; " + add + " }", "uniform int n;\n"), five, n);
  // 100 · 100 and 5 · 30000 / 5 turns are no end.
  same(sample("float s = 0.0; for (int i = 0; i < n; ++i) s += 1.0; c.r = s;", "uniform int n;\n"),
       sample("c.r = 30000.0;"), {{"n", number(30000)}});
  same(sample("float s = 0.0; for (int i = 0; i < n; ++i) for (int j = 0; j < n; ++j) s += 1.0; c.r = s;",
              "uniform int n;\n"),
       sample("c.r = 10000.0;"), {{"n", number(100)}});
  same(sample("float s = 0.0; for (int i = 0; i < 60; ++i) for (int j = 0; j < 60; ++j) s += 1.0; c.r = s;"),
       sample("c.r = 3600.0;"));
}

/// Each kernel's guard costs a buffer: small loops of constants have none.
TEST_F(EndlessLoops, SmallLoopsHaveNoGuard) {
  const auto guarded = [&](const std::string& body, const std::string& before = "") {
    const std::string name = "small" + std::to_string(++shaders_);
    shader(name, sample(body, before));
    KernelDesc desc;
    desc.sample = KernelStage{.shader = *library_->find(name), .constants = {}, .label = "s"};
    desc.config.guard_loops = true;
    const auto kernel = compiler_->compile(desc);
    EXPECT_TRUE(kernel) << kernel.error().text();
    EXPECT_TRUE(spvtools::SpirvTools(SPV_ENV_VULKAN_1_1).Validate(kernel->spirv));
    return !kernel->loops.empty();
  };
  EXPECT_FALSE(guarded("c *= 2.0;"));
  EXPECT_FALSE(guarded("for (int i = 0; i < 64; ++i) for (int j = 8; j > -9; j -= 2) c.r += 1.0;"));
  EXPECT_FALSE(guarded("for (int i = 0; i <= 4095; ++i) c.r += 1.0;"));
  EXPECT_FALSE(guarded("for (int i = 0; i < 9 && abs(c.r) < c.g; ++i) { if (c.b > c.r) break; c.r += 1.0; }"));
  EXPECT_TRUE(guarded("for (int i = 0; i < 9 || abs(c.r) < c.g; ++i) c.r += 1.0;"));
  EXPECT_TRUE(guarded("for (int i = 0; i < 9 && c.r < c.g; ++i) { if (c.b > c.r) i = 0; c.r += 1.0; }"));
  EXPECT_TRUE(guarded("for (int i = 0; i <= 4096; ++i) c.r += 1.0;"));
  EXPECT_TRUE(guarded("for (int i = 0; i < 65; ++i) for (int j = 0; j < 65; ++j) c.r += 1.0;"));
  EXPECT_TRUE(guarded("for (int i = 0; i < n; ++i) c.r += 1.0;", "uniform int n;\n"));
  EXPECT_TRUE(guarded("for (uint i = 0u; i < 5u; ++i) c.r += 1.0;")) << "other numbers are not followed";
}

}  // namespace
}  // namespace afterglow
