// SPDX-License-Identifier: MIT
// What half floats cost, by what the effects of a look promise.
#include <gtest/gtest.h>

#include "session/half_floats.h"

namespace afterglow {
namespace {

struct HalfFloatPromises : testing::Test {
  StackEntry& add(const std::string& name, double error, int members = 0) {
    StackEntry entry;
    entry.name = entry.effect = name;
    entry.members = members;
    entries->push_back(entry);
    Promises promise{name, {}};
    if (members == 0) {
      promise.invariants.push_back({.name = "error", .numbers = {{"fp16", error}, {"up_to", 65504}}});
      promise.invariants.push_back({.name = "continuous", .numbers = {{"slope", 1}}});
    }
    build.promises.push_back(promise);
    return entries->back();
  }
  double error() {
    build.entries = entries;
    return half_float_promise(build).error;
  }
  std::shared_ptr<std::vector<StackEntry>> entries = std::make_shared<std::vector<StackEntry>>();
  Build build;
};

TEST_F(HalfFloatPromises, AddUp) {
  add("a", 1e-3);
  add("b", 2e-3);
  EXPECT_DOUBLE_EQ(error(), 3e-3);
}

TEST_F(HalfFloatPromises, WhatAGroupMakesOfItsMembersCounts) {
  add("before", 1e-3);
  add("group", 0, 2).blend = "overlay";
  add("inner", 1e-3);
  add("last", 1e-3);
  add("behind", 1e-3);
  EXPECT_DOUBLE_EQ(error(), 4 * 3e-3 + 1e-3);
  (*entries)[1].blend = "normal";
  EXPECT_DOUBLE_EQ(error(), 4e-3) << "a group that does nothing itself";
  (*entries)[1].enabled = false;
  EXPECT_DOUBLE_EQ(error(), 2e-3) << "its members do not run";
}

TEST_F(HalfFloatPromises, GroupsEndWithTheStack) {
  add("outer", 0, 2).opacity = 0.5;
  add("inner", 0, 1).opacity = 0.5;
  add("a", 1e-3);
  EXPECT_DOUBLE_EQ(error(), 16e-3);
}

}  // namespace
}  // namespace afterglow
