// SPDX-License-Identifier: MIT
// Programs that are kept: found by all that makes them.
#include "renderer_test.h"

namespace afterglow {
namespace {

class ProgramCacheTest : public RendererTest {};

TEST_F(ProgramCacheTest, ProgramsAreFoundByAllThatMakesThemAndByNothingElse) {
  const auto programs = cache({.spare = 3});
  const auto work = [&](double gain, bool offset) {
    FrameWork out{.graph = graph(gain, offset)};
    out.texts = texts_of(out.graph, *library_).value();
    return out;
  };
  ASSERT_TRUE(programs->prepare(work(1, false), *library_));
  const std::uint64_t plain = programs->program()->id();
  EXPECT_TRUE(programs->has(work(9, false))) << "values make no new program";
  EXPECT_FALSE(programs->has(work(1, true))) << "passes do";
  FrameWork part = work(1, false);
  part.region = Rect{0, 0, 5, 5};
  EXPECT_FALSE(programs->has(part));
  FrameWork texts = work(1, false);
  texts.texts = Hash{1, 2};
  EXPECT_FALSE(programs->has(texts));
  FrameWork codes = work(1, false);
  codes.unorm8 = true;
  EXPECT_FALSE(programs->has(codes));
  ASSERT_TRUE(programs->prepare(work(1, true), *library_));
  const std::uint64_t other = programs->program()->id();
  EXPECT_NE(other, plain);
  ASSERT_TRUE(programs->prepare(work(4, false), *library_));
  EXPECT_EQ(programs->program()->id(), plain) << "it was spare";
  EXPECT_EQ(programs->program(plain), programs->program());
  EXPECT_EQ(programs->program(other), nullptr) << "of another structure";
  const auto none = cache();
  ASSERT_TRUE(none->prepare(work(1, false), *library_));
  ASSERT_TRUE(none->prepare(work(1, true), *library_));
  EXPECT_FALSE(none->has(work(1, false))) << "nothing is spare";
}

TEST_F(ProgramCacheTest, SpareProgramsHaveAQuarterOfTheMemory) {
  const auto work = [&](bool offset) {
    FrameWork out{.graph = graph(1, offset)};
    out.texts = texts_of(out.graph, *library_).value();
    return out;
  };
  const auto measured = cache({.reference = true, .spare = 1});
  ASSERT_TRUE(measured->prepare(work(false), *library_));
  std::uint64_t both = measured->program()->memory().arena;
  ASSERT_TRUE(measured->prepare(work(true), *library_));
  both += measured->program()->memory().arena;
  ASSERT_GT(both, 0u);
  for (const bool enough : {true, false}) {
    const auto programs = cache({.reference = true, .spare = 1, .max_memory = 4 * both - (enough ? 0 : 4)});
    ASSERT_TRUE(programs->prepare(work(false), *library_));
    ASSERT_TRUE(programs->prepare(work(true), *library_));
    EXPECT_EQ(programs->has(work(false)), enough);
  }
}

TEST_F(ProgramCacheTest, WhatCannotBeMadeLeavesNoPresentProgram) {
  const auto programs = cache();
  FrameWork good{.graph = graph(1)};
  good.texts = texts_of(good.graph, *library_).value();
  ASSERT_TRUE(programs->prepare(good, *library_));
  FrameWork bad = good;
  bad.region = Rect{0, 0, 1000, 1000};
  EXPECT_FALSE(programs->prepare(bad, *library_));
  EXPECT_EQ(programs->program(), nullptr);
  EXPECT_EQ(programs->work(), nullptr);
  EXPECT_TRUE(programs->prepare(good, *library_));
  EXPECT_NE(programs->program(), nullptr);
}

}  // namespace
}  // namespace afterglow
