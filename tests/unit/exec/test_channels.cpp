// SPDX-License-Identifier: MIT
// Images of one and two channels between kernels: readers find (r, 0, 0, 1) and (r, g, 0, 1) whatever the way of
// execution, to the bits that images of four channels hold, and memory of so many channels alone is taken.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "workshop.h"

namespace afterglow {
namespace {

/// How many channels each pass's image has, for a graph of four steps: a sample pass, a filter to half the size, a
/// pixel pass and one by workgroups.
struct Declared {
  int sample = 1, filter = 2, pixel = 2, compute = 1;
};

class FewChannels : public Workshop {
 protected:
  void SetUp() override {
    Workshop::SetUp();
    shader("spread",
           "uniform sampler2D source;\nvec4 sample_at(ivec2 p) { vec4 c = fetch(source, p);\n"
           "  return vec4(c.r + c.g, c.b - c.g, 7.0, -3.0) + 0.25 * fetch(source, p + ivec2(1, 0)); }\n");
    shader("bend", "vec4 apply(vec4 color, vec4 other) { return color * color + other.bgra; }\n");
    shader("group",
           "layout(local_size_x = 8, local_size_y = 4) in;\nuniform sampler2D source;\n"
           "vec4 compute_at(ivec2 p) { return fetch(source, p) - 0.5 * fetch(source, p - ivec2(0, 1)); }\n");
    shader("all",
           "uniform sampler2D a;\nuniform sampler2D b;\nuniform sampler2D c;\n"
           "vec4 sample_at(ivec2 p) { vec4 x = fetch(a, p / 2), y = fetch(b, p), z = fetch(c, p);\n"
           "  return vec4(x.r + y.g + z.b, x.g + y.b + z.a, x.b + y.a + z.r, x.a + y.r + z.g); }\n");
  }

  Graph steps(Size size, const Declared& declared = {}) {
    GraphBuilder b(size);
    const Size half{(size.width + 1) / 2, (size.height + 1) / 2};
    const ImageId spread = b.sample("spread", "spread", size, {{"source", b.source()}});
    const ImageId small =
        b.filter("small", spread, half, {.x = {{-0.5, 0.5}, {0.5, 0.5}}, .y = {{-0.5, 0.5}, {0.5, 0.5}}});
    const ImageId bent = b.pixel("bend", "bend", b.source(), {{"other", spread}});
    const ImageId grouped = b.sample("group", "group", size, {{"source", bent}});
    Graph graph = b.finish(b.sample("all", "all", size, {{"a", small}, {"b", bent}, {"c", grouped}}));
    graph.passes[3].kind = PassKind::compute;
    graph.images[static_cast<std::size_t>(spread)].channels = declared.sample;
    graph.images[static_cast<std::size_t>(small)].channels = declared.filter;
    graph.images[static_cast<std::size_t>(bent)].channels = declared.pixel;
    graph.images[static_cast<std::size_t>(grouped)].channels = declared.compute;
    return graph;
  }

  std::vector<float> made(const Graph& graph, Size size, const ProgramOptions& options = {}, bool direct = true) {
    const auto pixels = noise(size, 11);
    return run(graph, {{"source", {pixels.data(), size, 4}}}, options, direct).pixels;
  }
};

using Color = std::array<double, 4>;
Color held(Color c, int channels) {
  if (channels < 4) c[3] = 1, c[2] = 0;
  if (channels < 2) c[1] = 0;
  return c;
}

Picture64 map(Size size, const std::function<Color(int, int)>& color) {
  Picture64 out(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const Color c = color(x, y);
      for (int i = 0; i < 4; ++i) out.at(x, y, i) = c[static_cast<std::size_t>(i)];
    }
  return out;
}
Color at(const Picture64& p, int x, int y) { return {p.get(x, y, 0), p.get(x, y, 1), p.get(x, y, 2), p.get(x, y, 3)}; }

/// What `steps` makes, in double precision.
Picture64 expected(const Picture64& source, const Declared& declared) {
  const Size size = source.size, half{(size.width + 1) / 2, (size.height + 1) / 2};
  const Picture64 spread = map(size, [&](int x, int y) {
    const Color c = at(source, x, y), n = at(source, x + 1, y);
    const Color out{c[0] + c[1] + 0.25 * n[0], c[2] - c[1] + 0.25 * n[1], 7 + 0.25 * n[2], -3 + 0.25 * n[3]};
    return held(out, declared.sample);
  });
  const Picture64 whole = filter64(spread, {.x = {{-0.5, 0.5}, {0.5, 0.5}}, .y = {{-0.5, 0.5}, {0.5, 0.5}}}, half);
  const Picture64 small = map(half, [&](int x, int y) { return held(at(whole, x, y), declared.filter); });
  const Picture64 bent = map(size, [&](int x, int y) {
    const Color c = at(source, x, y), o = at(spread, x, y);
    return held({c[0] * c[0] + o[2], c[1] * c[1] + o[1], c[2] * c[2] + o[0], c[3] * c[3] + o[3]}, declared.pixel);
  });
  const Picture64 grouped = map(size, [&](int x, int y) {
    const Color c = at(bent, x, y), n = at(bent, x, y - 1);
    return held({c[0] - 0.5 * n[0], c[1] - 0.5 * n[1], c[2] - 0.5 * n[2], c[3] - 0.5 * n[3]}, declared.compute);
  });
  return map(size, [&](int x, int y) {
    const Color a = at(small, x / 2, y / 2), b = at(bent, x, y), c = at(grouped, x, y);
    return Color{a[0] + b[1] + c[2], a[1] + b[2] + c[3], a[2] + b[3] + c[0], a[3] + b[0] + c[1]};
  });
}

TEST_F(FewChannels, ReadersFindNoughtsAndOneForWhatIsNotThere) {
  for (const Size size : kSizes) {
    const Picture64 source = Picture64::of(size, noise(size, 11));
    for (const Declared declared : {Declared{}, Declared{2, 1, 1, 2}, Declared{4, 2, 1, 4}, Declared{4, 4, 4, 4}}) {
      expect_near(made(steps(size, declared), size), expected(source, declared), 1e-4, "fused");
      expect_near(made(steps(size, declared), size, {.reference = true}), expected(source, declared), 1e-4,
                  "reference");
    }
  }
}

TEST_F(FewChannels, AllWaysHoldTheBitsOfFourChannels) {
  const ExecutionConfig ways[] = {{},
                                  {.fusion = Fusion::none},
                                  {.fusion = Fusion::filters, .share_memory = false},
                                  {.storage = Storage::fp16},
                                  {.storage_reads = true},
                                  {.storage = Storage::fp16, .storage_reads = true},
                                  {.storage_reads = true, .rows = 4},
                                  {.storage_reads = true, .rows = 8},
                                  {.storage = Storage::fp16, .rows = 2},
                                  {.hardware_filter = true},
                                  {.storage = Storage::fp16, .hardware_filter = true}};
  for (const Size size : kSizes)
    for (const ExecutionConfig& way : ways)
      for (const bool direct : {true, false}) {
        ProgramOptions few{.config = way}, four = few;
        few.worth = four.worth = {0, 0};
        four.config.four_channels = true;
        const auto a = made(steps(size), size, few, direct), b = made(steps(size), size, four, direct);
        EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0) << execution_name(way);
      }
}

TEST_F(FewChannels, TakeTheMemoryOfSoMany) {
  const Size size{256, 128};
  for (const Storage storage : {Storage::fp32, Storage::fp16}) {
    ProgramOptions options{.config = {.fusion = Fusion::none, .storage = storage, .share_memory = false}};
    const auto few = program(steps(size), options);
    options.config.four_channels = true;
    const auto four = program(steps(size), options);
    ASSERT_TRUE(few && four);
    const std::uint64_t pixels = 256 * 128, channel = storage == Storage::fp16 ? 2 : 4;
    // Of spread, bend and group; of small a quarter.
    EXPECT_EQ(few->memory().sum, pixels * channel * (1 + 2 + 1) + pixels / 4 * channel * 2);
    EXPECT_EQ(four->memory().sum, pixels * channel * (4 + 4 + 4) + pixels / 4 * channel * 4);
  }
}

/// What is not there cannot be wrong; what is there is told as ever, whichever image it comes up in.
TEST_F(FewChannels, OnlyWhatIsStoredIsLookedAt) {
  const Size size{8, 4};
  shader("broken",
         "uniform sampler2D source;\nlayout(constant_id = 0) const int where = 0;\n"
         "vec4 sample_at(ivec2 p) { vec4 c = fetch(source, p);\n"
         "  if (p == ivec2(3, 1)) c[where] = uintBitsToFloat(0x7fc00000u); return c; }\n");
  shader("mean", "uniform sampler2D source;\nvec4 sample_at(ivec2 p) { return fetch(source, p); }\n");
  const std::vector<float> pixels(static_cast<std::size_t>(size.area()) * 4, 0.5f);
  for (const int channels : {1, 2, 4})
    for (const int where : {0, 1, 2}) {
      GraphBuilder b(size);
      const ImageId broken = b.sample("broken", "broken", size, {{"source", b.source()}});
      Graph graph = b.finish(b.sample("mean", "mean", size, {{"source", broken}}));
      graph.passes[0].constants = {{"where", where}};
      graph.images[static_cast<std::size_t>(broken)].channels = channels;
      const auto out = run(graph, {{"source", {pixels.data(), size, 4}}}, {.flag_non_finite = true}).pixels;
      for (std::size_t i = 0; i < static_cast<std::size_t>(size.area()); ++i)
        EXPECT_EQ(out[4 * i + 3], i == 11 && where < channels ? 0 : 1) << channels << " channels, " << where;
    }
}

/// The result and what the next frame gets are the caller's and the frames': four channels, with what readers find.
/// Full floats for one image, where the others are half floats.
TEST_F(FewChannels, APreciseImageIsNotHalved) {
  shader("up", "uniform sampler2D source;\nvec4 sample_at(ivec2 p) { return 1e6 * fetch(source, p); }\n");
  shader("down", "uniform sampler2D source;\nvec4 sample_at(ivec2 p) { return 1e-6 * fetch(source, p); }\n");
  const Size size{37, 21};
  const std::vector<float> source(static_cast<std::size_t>(size.area()) * 4, 1.0f);
  for (const int channels : {1, 4})
    for (const bool precise : {false, true})
      for (ExecutionConfig config : {ExecutionConfig{}, ExecutionConfig{.storage_reads = true, .rows = 4},
                                     ExecutionConfig{.dispatched = true}}) {
        config.storage = Storage::fp16;
        GraphBuilder b(size);
        const ImageId up = b.sample("up", "up", size, {{"source", b.source()}});
        Graph graph = b.finish(b.sample("down", "down", size, {{"source", up}}));
        graph.images[static_cast<std::size_t>(up)].precise = precise;
        graph.images[static_cast<std::size_t>(up)].channels = channels;
        const auto out = run(graph, {{"source", {source.data(), size, 4}}},
                             {.config = config, .inputs_are_storage = true, .worth = {0, 0}, .result_stored = true});
        ASSERT_FALSE(out.pixels.empty());
        EXPECT_NEAR(out.pixels[0], precise ? 1 : 0.065504f, 1e-3f) << execution_name(config) << channels;
      }
}

TEST_F(FewChannels, TheResultHasFour) {
  const Size size{7, 3};
  const auto pixels = noise(size, 11);
  GraphBuilder b(size);
  Graph graph = b.finish(b.sample("spread", "spread", size, {{"source", b.source()}}));
  graph.images[static_cast<std::size_t>(graph.result)].channels = 1;
  EXPECT_EQ(stored_channels(graph, graph.result, {}), 4);
  const auto out = made(graph, size);
  for (std::size_t i = 0; i < out.size(); i += 4) {
    EXPECT_NE(out[i], 0);
    EXPECT_EQ(out[i + 1], 0);
    EXPECT_EQ(out[i + 2], 0);
    EXPECT_EQ(out[i + 3], 1);
  }
}

}  // namespace
}  // namespace afterglow
