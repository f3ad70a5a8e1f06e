// SPDX-License-Identifier: MIT
// Thousands of reloads leave nothing behind.
#include "live_fixture.h"
#include "resident.h"

namespace afterglow {
namespace {

class LiveMemory : public LiveTest {
 protected:
  void value_edit(int i) {
    save(i % 50 * 2);
    live().settle();
    ASSERT_TRUE(i % 10 == 0 ? shown() == static_cast<float>(i % 50) : live().update());
  }
  void shader_edit(int i) {
    write("shaders/t/lib.glsl", "vec3 tinted(vec3 c, float gain) { return c * gain + " + std::to_string(i) + ".0; }\n");
    save(2);
    ASSERT_EQ(settled(), 1.f + static_cast<float>(i));
  }
};

TEST_F(LiveMemory, TenThousandReloads) {
  open_unwatched();
  // Allocators, drivers and caches need some rounds until they hold what they will hold.
  for (int i = 0; i < 500; ++i) value_edit(i);
  const auto lua = live().stack()->preset().memory_used();
  const auto before = live().counters();
  const auto bytes = resident();
  for (int i = 0; i < 10'000; ++i) value_edit(i);
  live().settle();
  const auto after = live().counters();
  EXPECT_EQ(after.values, before.values + 10'000);
  EXPECT_EQ(after.structures, before.structures);
  EXPECT_EQ(after.compiled, before.compiled);
  EXPECT_EQ(after.pipelines, before.pipelines);
  EXPECT_LE(after.stacks, 2u);
  EXPECT_EQ(live().stack()->preset().memory_used(), lua);
  EXPECT_LT(resident(), bytes + (8u << 20)) << "800 bytes a reload would show";
}

TEST_F(LiveMemory, ManyShaderEdits) {
  open_unwatched();
  for (int i = 0; i < 40; ++i) shader_edit(i);
  live().settle();  // what was replaced is gone
  const auto before = live().counters();
  const auto bytes = resident();
  for (int i = 0; i < 150; ++i) shader_edit(1000 + i);
  live().settle();
  const auto after = live().counters();
  EXPECT_EQ(after.pipelines_alive, before.pipelines_alive);
  EXPECT_EQ(after.pipelines, before.pipelines + 150);
  EXPECT_LE(after.stacks, 2u);
  EXPECT_LT(resident(), bytes + (24u << 20)) << "of 150 shaders, each with its code";
}

}  // namespace
}  // namespace afterglow
