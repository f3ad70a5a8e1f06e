// SPDX-License-Identifier: MIT
// Choices of execution as text.
#include <gtest/gtest.h>

#include "shader/execution_config.h"

namespace afterglow {
namespace {

TEST(ExecutionConfig, NamesSayAllThatIsNotDefault) {
  EXPECT_EQ(execution_name({}), "fused fp32");
  EXPECT_EQ(execution_name({.storage_reads = true, .rows = 8}), "fused fp32 storage-reads rows8");
  EXPECT_EQ(execution_name(kPlain16f), "fused-filters fp16 hardware-filter");
  EXPECT_EQ(execution_name({.fusion = Fusion::none, .share_memory = false}), "unfused fp32 unshared");
}

TEST(ExecutionConfig, EveryNameReadsBackAsTheSameChoice) {
  int read = 0;
  for (const auto fusion : {Fusion::none, Fusion::filters, Fusion::all})
    for (const auto storage : {Storage::fp32, Storage::fp16})
      for (int bits = 0; bits < 64; ++bits)
        for (const int rows : {1, 2, 8}) {
          const ExecutionConfig choice{.fusion = fusion,
                                       .storage = storage,
                                       .hardware_filter = (bits & 1) != 0,
                                       .storage_reads = (bits & 2) != 0,
                                       .compute = (bits & 4) != 0,
                                       .dispatched = (bits & 32) != 0,
                                       .four_channels = (bits & 8) != 0,
                                       .share_memory = (bits & 16) != 0,
                                       .rows = rows};
          const auto parsed = parse_execution(execution_name(choice));
          ASSERT_TRUE(parsed) << parsed.error().text();
          EXPECT_EQ(*parsed, choice) << execution_name(choice);
          ++read;
        }
  EXPECT_EQ(read, 1152);
}

TEST(ExecutionConfig, WordsMayComeInAnyOrderAndWithPlus) {
  EXPECT_EQ(*parse_execution("rows4+fp16+fused-filters"),
            (ExecutionConfig{.fusion = Fusion::filters, .storage = Storage::fp16, .rows = 4}));
  EXPECT_EQ(*parse_execution("plain16f"), kPlain16f);
  EXPECT_EQ(*parse_execution("plain32f storage-reads"),
            (ExecutionConfig{.fusion = Fusion::filters, .hardware_filter = true, .storage_reads = true}));
}

TEST(ExecutionConfig, UnknownWordsSayWhatIsAllowed) {
  for (const char* text : {"joind", "rows0", "rows9", "rows", "rows3x", "fp8"}) {
    const auto parsed = parse_execution(text);
    ASSERT_FALSE(parsed) << text;
    EXPECT_EQ(parsed.error().kind, ErrorKind::usage);
    EXPECT_NE(parsed.error().allowed.find("storage-reads"), std::string::npos);
  }
  EXPECT_EQ(parse_execution("fusd").error().nearest, "fused");
}

}  // namespace
}  // namespace afterglow
