// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "graph/difference.h"
#include "graphs.h"

namespace afterglow {
namespace {
using test::Builder;

Graph two_effects(int passes_of_first, double gain = 1) {
  Builder b;
  ImageId image = b.graph.source;
  for (int i = 0; i < passes_of_first; ++i) {
    image = b.pixel("a" + std::to_string(i), image);
    b.graph.passes.back().effect = "first";
  }
  b.pixel("b", image);
  b.graph.passes.back().effect = "second";
  b.graph.passes.back().params["gain"] = {ParamType::float1, {gain}};
  return b.graph;
}

std::string text(const std::optional<Difference>& found) { return found ? found->effect + ": " + found->what : ""; }

TEST(Difference, NamesTheEffectAndWhatIsOtherwise) {
  const Graph graph = two_effects(1);
  EXPECT_EQ(text(first_difference(graph, two_effects(1))), "");
  EXPECT_EQ(text(first_difference(graph, two_effects(1, 0.5))), "second: gain of pass 'test.b' is 1, then 0.5");
  EXPECT_EQ(text(first_difference(graph, two_effects(2))), "first: the number of its passes is 1, then 2")
      << "images of the second have other ids, which is not its doing";
  Graph other = graph;
  other.passes[0].constants["taps"] = 3;
  EXPECT_EQ(text(first_difference(graph, other)), "first: pass 'test.a0' is made otherwise");
  other = graph;
  other.images[static_cast<std::size_t>(other.passes[1].output)].channels = 1;
  EXPECT_EQ(text(first_difference(graph, other)), "second: pass 'test.b' is made otherwise");
  other = graph;
  other.images[static_cast<std::size_t>(other.source)].data =
      std::make_shared<const ImageData>(ImageData{.size = {1, 1}, .pixels = {}, .hash = {1, 2}, .file = {}});
  EXPECT_EQ(text(first_difference(graph, other)), "first: pass 'test.a0' is made otherwise");
  other = graph;
  other.idle.push_back({"second", other.source, other.result, 1});
  EXPECT_EQ(text(first_difference(graph, other)), "second: idle gives another limit");
  other = graph;
  other.skipped.push_back({"third", "strength is 0"});
  EXPECT_EQ(text(first_difference(graph, other)), "third: it is not left out each time for the same reason");
  EXPECT_EQ(text(first_difference(other, graph)), "third: it is not left out each time for the same reason");
}

TEST(Difference, OfAnImageThatIsReturned) {
  const Graph graph = two_effects(2);
  Graph other = graph;
  other.result = other.passes[0].output;
  EXPECT_EQ(text(first_difference(graph, other)), "second: it returns another image");
  other.result = other.source;
  EXPECT_EQ(text(first_difference(other, graph)), "second: it returns another image");
}

}  // namespace
}  // namespace afterglow
