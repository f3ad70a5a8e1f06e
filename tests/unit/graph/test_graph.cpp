// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "graphs.h"

namespace afterglow {
namespace {
using test::Builder;

TEST(Validate, AcceptsGraphsAsBuilt) {
  Builder b;
  const ImageId half = b.filter("down", b.graph.source, {8, 4});
  const ImageId up = b.filter("up", half, {16, 8});
  b.pixel("add", up, {{"high", b.graph.source, true}});
  EXPECT_TRUE(validate(b.graph));
  EXPECT_TRUE(validate(Builder({1, 1}).graph));
}

TEST(Validate, NamesEffectPassAndPlace) {
  Builder b;
  const ImageId half = b.filter("down", b.graph.source, {8, 4});
  b.pixel("add", b.graph.source, {{"high", half, true}});
  EXPECT_EQ(
      validate(b.graph).error().text(),
      "test.lua:2: error: pass 'test.add' of effect 'test': input 'high' is 8×4 but is read pixel by pixel into 16×8");
}

TEST(Validate, RefusesWhatNoProgramCanRun) {
  Builder reads_later;
  reads_later.pixel("a", reads_later.graph.source);
  reads_later.pixel("b", reads_later.graph.result);
  reads_later.graph.passes[0].inputs[0].image = reads_later.graph.passes[1].output;
  EXPECT_NE(validate(reads_later.graph).error().message.find("before it is made"), std::string::npos);

  Builder twice;
  twice.pixel("a", twice.graph.source);
  twice.pixel("a", twice.graph.result);
  EXPECT_NE(validate(twice.graph).error().message.find("same name"), std::string::npos);

  Builder rewritten;
  rewritten.pixel("a", rewritten.graph.source);
  rewritten.pixel("b", rewritten.graph.source);
  rewritten.graph.passes[1].output = rewritten.graph.passes[0].output;
  EXPECT_NE(validate(rewritten.graph).error().message.find("again"), std::string::npos);

  Builder empty;
  empty.filter("down", empty.graph.source, {0, 4});
  EXPECT_NE(validate(empty.graph).error().message.find("no pixels"), std::string::npos);

  Builder small;
  small.filter("down", small.graph.source, {8, 4});
  EXPECT_TRUE(validate(small.graph).ok()) << "images between passes are shown too";

  Builder lost;
  lost.pixel("a", lost.graph.source);
  lost.graph.passes[0].inputs[0].image = 77;
  EXPECT_NE(validate(lost.graph).error().message.find("no image of this graph"), std::string::npos);

  Graph none;
  EXPECT_FALSE(validate(none));
}

TEST(SameStructure, IgnoresDynamicValuesAlone) {
  const auto make = [](double value, double constant, ParamType type) {
    Builder b;
    b.pixel("a", b.graph.source);
    b.graph.passes[0].params["gain"] = {type, {value}};
    b.graph.passes[0].constants["mode"] = constant;
    return b.graph;
  };
  const Graph a = make(1, 0, ParamType::float1);
  EXPECT_TRUE(same_structure(a, make(2, 0, ParamType::float1)));
  EXPECT_FALSE(same_structure(a, make(1, 1, ParamType::float1)));
  EXPECT_FALSE(same_structure(a, make(1, 0, ParamType::float2)));
  Graph other = a;
  other.images[1].size = {4, 4};
  EXPECT_FALSE(same_structure(a, other));
}

TEST(Json, HoldsPassesInputsAndReasons) {
  Builder b;
  b.pixel("a", b.graph.source);
  b.graph.passes[0].params["color"] = {ParamType::float3, {1, 2, 3}};
  b.graph.skipped.push_back({"bloom", "intensity is 0"});
  const auto json = nlohmann::json::parse(to_json(b.graph));
  EXPECT_EQ(json["passes"][0]["name"], "test.a");
  EXPECT_EQ(json["passes"][0]["inputs"]["source"], "source");
  EXPECT_EQ(json["passes"][0]["parameters"]["color"], (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(json["skipped"][0]["reason"], "intensity is 0");
}

}  // namespace
}  // namespace afterglow
