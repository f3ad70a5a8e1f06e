// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include "core/module.h"

namespace afterglow {
namespace {

using testing::HasSubstr;

TEST(Module, OfAnotherBuildIsRefused) {
  const auto loaded = load_module("afterglow_other_build.so", "afterglow_entry");
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().kind, ErrorKind::io);
  EXPECT_THAT(loaded.error().message, HasSubstr("afterglow_other_build.so is of another build of Afterglow"));
}

TEST(Module, ThatIsNotThereIsTold) {
  const auto loaded = load_module("afterglow_nothing.so", "afterglow_entry");
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().message, "afterglow_nothing.so (not found)");
}

}  // namespace
}  // namespace afterglow
