// Choices of execution as text.
#include <gtest/gtest.h>

#include "exec/choice.h"

namespace afterglow {
namespace {

TEST(Choice, NamesSayAllThatIsNotDefault) {
  EXPECT_EQ(choice_name({}), "joined fp32");
  EXPECT_EQ(choice_name({.storage_reads = true, .rows = 8}), "joined fp32 storage-reads rows8");
  EXPECT_EQ(choice_name(kPlain16f), "heads fp16 hardware-filter");
  EXPECT_EQ(choice_name({.joining = Joining::none, .share_memory = false}), "apart fp32 unshared");
}

TEST(Choice, EveryNameReadsBackAsTheSameChoice) {
  int read = 0;
  for (const auto joining : {Joining::none, Joining::heads, Joining::all})
    for (const auto storage : {Storage::fp32, Storage::fp16})
      for (int bits = 0; bits < 8; ++bits)
        for (const int rows : {1, 2, 8}) {
          const Choice choice{joining, storage, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, rows};
          const auto parsed = parse_choice(choice_name(choice));
          ASSERT_TRUE(parsed) << parsed.error().text();
          EXPECT_EQ(*parsed, choice) << choice_name(choice);
          ++read;
        }
  EXPECT_EQ(read, 144);
}

TEST(Choice, WordsMayComeInAnyOrderAndWithPlus) {
  EXPECT_EQ(*parse_choice("rows4+fp16+heads"),
            (Choice{.joining = Joining::heads, .storage = Storage::fp16, .rows = 4}));
  EXPECT_EQ(*parse_choice("plain16f"), kPlain16f);
  EXPECT_EQ(*parse_choice("plain32f storage-reads"),
            (Choice{.joining = Joining::heads, .hardware_filter = true, .storage_reads = true}));
}

TEST(Choice, UnknownWordsSayWhatIsAllowed) {
  for (const char* text : {"joind", "rows0", "rows9", "rows", "rows3x", "fp8"}) {
    const auto parsed = parse_choice(text);
    ASSERT_FALSE(parsed) << text;
    EXPECT_EQ(parsed.error().kind, ErrorKind::usage);
    EXPECT_NE(parsed.error().allowed.find("storage-reads"), std::string::npos);
  }
  EXPECT_EQ(parse_choice("joind").error().nearest, "joined");
}

TEST(Choice, BecomesOptionsOfAProgram) {
  const ProgramOptions options = program_options({.joining = Joining::heads,
                                                  .storage = Storage::fp16,
                                                  .hardware_filter = true,
                                                  .storage_reads = true,
                                                  .share_memory = false,
                                                  .rows = 4});
  EXPECT_EQ(options.rows, 4);
  EXPECT_EQ(options.joining, Joining::heads);
  EXPECT_EQ(options.storage, Storage::fp16);
  EXPECT_TRUE(options.hardware_filter);
  EXPECT_TRUE(options.storage_reads);
  EXPECT_FALSE(options.share_memory);
}

}  // namespace
}  // namespace afterglow
