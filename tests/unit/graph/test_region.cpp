// SPDX-License-Identifier: MIT
// What a part of the result needs of each image, against a search pixel by pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "graph/region.h"
#include "graphs.h"

namespace afterglow {
namespace {

using test::Builder;
using Pixels = std::set<std::pair<int, int>>;

bool holds(const Rect& rect, const std::pair<int, int>& p) {
  return p.first >= rect.x && p.first < rect.x + rect.width && p.second >= rect.y && p.second < rect.y + rect.height;
}

/// Texels that one read at t (a texel's centre is at its number) touches.
std::vector<int> texels(double t, const Filter& filter, int size) {
  const Interpolation interpolation = filter.interpolation;
  const int base = static_cast<int>(std::floor(interpolation == Interpolation::nearest ? t + 0.5 : t));
  const int first = interpolation == Interpolation::cubic_bspline ? -1 : 0;
  const int last = interpolation == Interpolation::nearest ? 0 : interpolation == Interpolation::linear ? 1 : 2;
  std::vector<int> out;
  for (int i = first; i <= last; ++i) {
    int at = base + i;
    if (filter.edges == Edges::mirror)
      while (at < 0 || at >= size) at = at < 0 ? -1 - at : 2 * size - 1 - at;
    out.push_back(std::clamp(at, 0, size - 1));
  }
  return out;
}

/// Pixels of an input that one pixel of the target needs.
void add_reads(const Graph& graph, const Pass& pass, const PassInput& input, int x, int y, Pixels& out) {
  const Size from = graph.images[input.image].size, to = graph.images[pass.output].size;
  if (input.pixelwise) {
    out.insert({x, y});
    return;
  }
  const double tx = (x + 0.5) * from.width / to.width - 0.5, ty = (y + 0.5) * from.height / to.height - 0.5;
  if (pass.kind == PassKind::sample) {
    for (int v = 0; v < from.height; ++v)
      for (int u = 0; u < from.width; ++u)
        if (!pass.reach || (std::abs(u - tx) <= *pass.reach && std::abs(v - ty) <= *pass.reach)) out.insert({u, v});
    return;
  }
  std::vector<Tap2d> taps = pass.filter.taps;
  if (taps.empty())
    for (const auto& a : pass.filter.x)
      for (const auto& b : pass.filter.y) taps.push_back({a.offset, b.offset, 1});
  for (const auto& tap : taps)
    for (const int u : texels(tx + tap.dx, pass.filter, from.width))
      for (const int v : texels(ty + tap.dy, pass.filter, from.height)) out.insert({u, v});
}

std::vector<Pixels> search(const Graph& graph, const Rect& wanted) {
  std::vector<Pixels> needed(graph.images.size());
  for (int y = wanted.y; y < wanted.y + wanted.height; ++y)
    for (int x = wanted.x; x < wanted.x + wanted.width; ++x) needed[graph.result].insert({x, y});
  for (std::size_t p = graph.passes.size(); p-- > 0;)
    for (const auto& [x, y] : needed[graph.passes[p].output])
      for (const auto& input : graph.passes[p].inputs)
        add_reads(graph, graph.passes[p], input, x, y, needed[input.image]);
  return needed;
}

class RandomGraph {
 public:
  explicit RandomGraph(unsigned seed) : random_(seed) {}

  Graph make() {
    const Size full{number(3, 33), number(3, 33)};
    Builder b(full);
    std::vector<ImageId> images{b.graph.source};
    const int passes = number(1, 7);
    for (int i = 0; i < passes; ++i) images.push_back(add(b, images, i, i + 1 == passes));
    return b.graph;
  }
  int number(int low, int high) { return low + static_cast<int>(random_() % static_cast<unsigned>(high - low + 1)); }

 private:
  ImageId add(Builder& b, const std::vector<ImageId>& images, int i, bool last) {
    const std::string name = "p" + std::to_string(i);
    const ImageId from = images[static_cast<std::size_t>(number(0, i))];
    const Size full = b.graph.images[0].size;
    const Size size = last ? full : Size{number(1, 33), number(1, 33)};
    const int kind = number(0, 2);
    if (kind == 0 && (!last || b.graph.images[from].size == full)) {
      std::vector<PassInput> more;
      for (const ImageId other : images)
        if (other != from && b.graph.images[other].size == b.graph.images[from].size && number(0, 1))
          more.push_back({"more" + std::to_string(other), other, true});
      return b.pixel(name, from, more);
    }
    if (kind == 1) {
      const ImageId made =
          b.sample(name, {{"source", from}, {"other", images[static_cast<std::size_t>(number(0, i))]}}, size);
      if (number(0, 3)) b.graph.passes.back().reach = number(0, 5) / 2.0;
      return made;
    }
    const ImageId made = b.filter(name, from, size);
    Filter& filter = b.graph.passes.back().filter;
    filter.interpolation = static_cast<Interpolation>(number(0, 2));
    filter.edges = static_cast<Edges>(number(0, 1));
    const auto offset = [&] { return number(-36, 36) / 4.0; };
    if (number(0, 1)) {
      filter.x.assign(static_cast<std::size_t>(number(1, 3)), {});
      filter.y.assign(static_cast<std::size_t>(number(1, 3)), {});
      for (auto& tap : filter.x) tap.offset = offset();
      for (auto& tap : filter.y) tap.offset = offset();
    } else {
      filter.taps.assign(static_cast<std::size_t>(number(1, 4)), {});
      for (auto& tap : filter.taps) tap = {offset(), offset(), 1};
    }
    return made;
  }
  std::mt19937 random_;
};

TEST(Region, HoldsEveryPixelThatIsNeeded) {
  for (unsigned seed = 0; seed < 400; ++seed) {
    RandomGraph random(seed);
    const Graph graph = random.make();
    ASSERT_TRUE(validate(graph)) << validate(graph).error().text();
    const Size size = graph.images[graph.result].size;
    Rect wanted{random.number(0, size.width - 1), random.number(0, size.height - 1), 0, 0};
    wanted.width = random.number(1, size.width - wanted.x);
    wanted.height = random.number(1, size.height - wanted.y);
    const Plan plan = make_plan(graph, {.fusion = random.number(0, 1) ? Fusion::all : Fusion::none});
    std::vector<Size> blocks(plan.kernels.size());
    for (Size& block : blocks) block = {1 << random.number(0, 4), random.number(1, 9)};
    const Regions found = regions(graph, plan, wanted, blocks);
    const auto needed = search(graph, wanted);
    for (std::size_t i = 0; i < graph.images.size(); ++i) {
      const Size all = graph.images[i].size;
      EXPECT_GE(found.images[i].x, 0);
      EXPECT_GE(found.images[i].y, 0);
      EXPECT_LE(found.images[i].x + found.images[i].width, all.width);
      EXPECT_LE(found.images[i].y + found.images[i].height, all.height);
      for (const auto& pixel : needed[i])
        ASSERT_TRUE(holds(found.images[i], pixel)) << "seed " << seed << " " << graph.images[i].name;
    }
    for (std::size_t k = 0; k < plan.kernels.size(); ++k) {
      const Rect &drawn = found.kernels[k], &read = found.images[plan.kernels[k].output];
      const Size all = graph.images[plan.kernels[k].output].size;
      if (read.width <= 0 || read.height <= 0) continue;
      EXPECT_EQ(united(drawn, read), drawn);
      const int right = drawn.x + drawn.width, below = drawn.y + drawn.height;
      EXPECT_EQ(drawn.x % blocks[k].width, 0);
      EXPECT_EQ(drawn.y % blocks[k].height, 0);
      EXPECT_TRUE(right == all.width || right % blocks[k].width == 0) << right;
      EXPECT_TRUE(below == all.height || below % blocks[k].height == 0) << below;
    }
  }
}

TEST(Region, PixelPassesNeedNoMoreThanTheirOwnPixels) {
  Builder b({40, 30});
  b.pixel("c", b.pixel("a", b.graph.source), {});
  const Plan plan = make_plan(b.graph, {});
  const Rect wanted{5, 6, 7, 8};
  const Regions found = regions(b.graph, plan, wanted);
  EXPECT_EQ(found.kernels, std::vector<Rect>{wanted});
  EXPECT_EQ(found.images[b.graph.source], wanted);
}

TEST(Region, SamplePassesReadAllUnlessTheyStateAReach) {
  Builder b({40, 30});
  b.sample("s", {{"source", b.graph.source}}, {40, 30});
  const Plan plan = make_plan(b.graph, {});
  EXPECT_EQ(regions(b.graph, plan, {20, 20, 1, 1}).images[0], (Rect{0, 0, 40, 30}));
  Graph near = b.graph;
  near.passes[0].reach = 2;
  const Rect read = regions(near, plan, {20, 20, 1, 1}).images[0];
  EXPECT_EQ(read, (Rect{17, 17, 7, 7}));  // 2 and the one that rounding is given
  EXPECT_FALSE(same_reach(b.graph, near));
  EXPECT_TRUE(same_reach(near, near));
}

TEST(Region, FiltersNeedTheReachOfTheirTapsAtTheirScale) {
  Builder b({64, 64});
  const ImageId half = b.filter("half", b.graph.source, {32, 32});
  b.filter("up", half, {64, 64});
  const Plan plan = make_plan(b.graph, {});
  const Regions found = regions(b.graph, plan, {30, 30, 4, 4});
  EXPECT_LE(found.images[half].width, 10);
  EXPECT_LE(found.images[b.graph.source].width, 28);
}

TEST(Region, SaysHowMuchIsNotDrawn) {
  Builder b({40, 30});
  b.pixel("a", b.graph.source);
  const Plan plan = make_plan(b.graph, {});
  const Skipped said = skipped_pixels(b.graph, plan, regions(b.graph, plan, {0, 0, 20, 15}));
  EXPECT_EQ(said.name, "75.0 % of the pixels");
  EXPECT_EQ(said.reason, "the region does not need them");
}

TEST(Region, UnitesRectangles) {
  EXPECT_EQ(united({1, 2, 3, 4}, {}), (Rect{1, 2, 3, 4}));
  EXPECT_EQ(united({}, {1, 2, 3, 4}), (Rect{1, 2, 3, 4}));
  EXPECT_EQ(united({1, 2, 3, 4}, {5, 0, 1, 1}), (Rect{1, 0, 5, 6}));
}

}  // namespace
}  // namespace afterglow
