// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "image/sequence.h"
#include "make_files.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Frames, RangesStepsAndLists) {
  EXPECT_THAT(parse_frames("7").value(), ElementsAre(7));
  EXPECT_THAT(parse_frames("1-4").value(), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(parse_frames("1-6x2").value(), ElementsAre(1, 3, 5));
  EXPECT_THAT(parse_frames("5,1, 10-12").value(), ElementsAre(5, 1, 10, 11, 12));
  EXPECT_THAT(parse_frames("1-3,2-4").value(), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(parse_frames("-2-1").value(), ElementsAre(-2, -1, 0, 1));
}

TEST(Frames, Refused) {
  for (const char* text :
       {"", "a", "1-", "1-x2", "4-1", "1-4x0", "1-4x-1", "1-4y", "1,,2", "99999999999", "1-2x", "0-2147483647"}) {
    const auto frames = parse_frames(text);
    ASSERT_FALSE(frames) << text;
    EXPECT_EQ(frames.error().kind, ErrorKind::usage) << text;
    EXPECT_THAT(frames.error().message, HasSubstr("frame list")) << text;
  }
  EXPECT_EQ(parse_frames("1-1000000").value().size(), 1000000u);
  EXPECT_FALSE(parse_frames("1-1000000,2000000"));
  std::string again = "1-1000000";  // the same frames, a hundred thousand times
  for (int i = 0; i < 100'000; ++i) again += ",1-1000000";
  EXPECT_FALSE(parse_frames(again));
}

TEST(Pattern, PlacesForNumbers) {
  EXPECT_EQ(parse_pattern("a/shot.####.exr").value().file(12), "a/shot.0012.exr");
  EXPECT_EQ(parse_pattern("a/shot.%04d.exr").value().file(12), "a/shot.0012.exr");
  EXPECT_EQ(parse_pattern("shot%d.exr").value().file(12), "shot12.exr");
  EXPECT_EQ(parse_pattern("shot.#.exr").value().file(12345), "shot.12345.exr");
  for (const char* text : {"100%%.exr", "100%.exr"}) EXPECT_EQ(parse_pattern(text).value().file(1), "100%.exr");
  EXPECT_FALSE(parse_pattern("plain.exr").value().numbered);
}

TEST(Pattern, Refused) {
  for (const char* text : {"a.##.b.##.exr", "a%s.exr", "a%4d.exr", "a####/b.exr", "a%04d##.exr", "", "##########.exr"})
    EXPECT_FALSE(parse_pattern(text)) << text;
}

TEST(Pattern, FindsItsOwnSpellingOnly) {
  const TemporaryFolder folder;
  for (const char* name : {"s.0001.exr", "s.0010.exr", "s.0002.exr", "s.3.exr", "s.00004.exr", "s.12345.exr",
                           "s.00a1.exr", "t.0005.exr", "s.0006.exr.tmp"})
    std::ofstream(folder / name) << "x";
  const auto found = find_frames(parse_pattern((folder / "s.####.exr").string()).value(), std::nullopt);
  ASSERT_TRUE(found);
  std::vector<int> numbers;
  for (const FrameFile& frame : found.value()) numbers.push_back(frame.frame);
  EXPECT_THAT(numbers, ElementsAre(1, 2, 10, 12345));
  EXPECT_EQ(found.value()[2].file, folder / "s.0010.exr");
}

TEST(Pattern, AskedForFramesAreListedEvenWhenMissing) {
  const TemporaryFolder folder;
  const auto found = find_frames(parse_pattern((folder / "s.##.exr").string()).value(), std::vector<int>{3, 1});
  ASSERT_EQ(found.value().size(), 2u);
  EXPECT_EQ(found.value()[0].file, folder / "s.03.exr");
}

TEST(Pattern, NothingFound) {
  const TemporaryFolder folder;
  EXPECT_EQ(find_frames(parse_pattern((folder / "s.##.exr").string()).value(), std::nullopt).error().kind,
            ErrorKind::io);
  EXPECT_EQ(find_frames(parse_pattern((folder / "no/s.##.exr").string()).value(), std::nullopt).error().kind,
            ErrorKind::io);
}

TEST(Pattern, PlainFilesHaveTheirOwnNumber) {
  EXPECT_EQ(find_frames({"a/shot.0012.exr", "", 0, false}, std::nullopt).value()[0].frame, 12);
  EXPECT_EQ(find_frames({"a/still.exr", "", 0, false}, std::nullopt).value()[0].frame, 1);
  EXPECT_EQ(find_frames({"a/shot.-002.exr", "", 0, false}, std::nullopt).value()[0].frame, -2);
  EXPECT_EQ(find_frames({"a/shot_-2.exr", "", 0, false}, std::nullopt).value()[0].frame, -2);
  EXPECT_EQ(find_frames({"a/2026-11-02.exr", "", 0, false}, std::nullopt).value()[0].frame, 2);
  EXPECT_EQ(find_frames({"a/20261121000000000000.exr", "", 0, false}, std::nullopt).value()[0].frame, 1);
  EXPECT_EQ(find_frames({"a/shot.0012_beauty.exr", "", 0, false}, std::nullopt).value()[0].frame, 12);
  EXPECT_EQ(find_frames({"a/hero_1080p.exr", "", 0, false}, std::nullopt).value()[0].frame, 1);
  EXPECT_EQ(find_frames({"a/shot_0012_1080p.exr", "", 0, false}, std::nullopt).value()[0].frame, 12);
}

TEST(Pattern, FramesOfASequenceDifferInTheirNumberAlone) {
  EXPECT_EQ(without_frame_number("a/shot.0012.exr"), "a/shot.*.exr");
  EXPECT_EQ(without_frame_number("a/shot.-002.exr"), "a/shot.*.exr");
  EXPECT_EQ(without_frame_number("a/shot.0012_beauty.exr"), "a/shot.*_beauty.exr");
  EXPECT_EQ(without_frame_number("a/shot_0012_4k.exr"), "a/shot_*_4k.exr");
  EXPECT_EQ(without_frame_number("a1/still.exr"), "a1/still.exr");
  EXPECT_EQ(without_frame_number("20261121000000000000.exr"), "20261121000000000000.exr");
}

TEST(Pattern, AFileThatOnlyLooksLikeAPattern) {
  const TemporaryFolder folder;
  std::ofstream(folder / "take#2.exr") << "x";
  EXPECT_FALSE(parse_pattern((folder / "take#2.exr").string()).value().numbered);
}

TEST(Pattern, FoldersAreCalledWhatTheyAreCalled) {
  const TemporaryFolder folder;
  for (const char* name : {"take#2", "p 100%", "50%%", "%04d"}) {
    const auto inside = folder / name;
    std::filesystem::create_directory(inside);
    std::ofstream(inside / "s.0003.exr") << "x";
    const std::string pattern = sequence_in(inside).value();
    EXPECT_EQ(pattern, inside / "s.####.exr");
    EXPECT_EQ(parse_pattern(pattern).value().file(3), inside / "s.0003.exr");
    EXPECT_EQ(parse_pattern((inside / "new.exr").string()).value().file(1), inside / "new.exr");
  }
  EXPECT_EQ(parse_pattern("no such 50%%/take#3/s.##.exr").value().file(7), "no such 50%/take#3/s.07.exr");
}

TEST(Pattern, PicturesBesideTheSequenceOfAFolderAreNamed) {
  const TemporaryFolder folder;
  for (const char* name : {"n.0001.exr", "n.0002.exr", "still.exr", "cover.exr", "notes.txt", ".hidden.exr"})
    std::ofstream(folder / name) << "x";
  Messages messages;
  EXPECT_EQ(with_sequences({folder.path()}, messages.diagnostics).value().front(), folder / "n.####.exr");
  EXPECT_THAT(messages.warnings,
              testing::ElementsAre(testing::HasSubstr(": cover.exr and 1 more are left out: a folder")));
}

TEST(Pattern, FramesBeforeZeroAreOfTheSequence) {
  const TemporaryFolder folder;
  for (const char* name : {"n.-002.exr", "n.-001.exr", "n.0000.exr", "n.0001.exr"}) std::ofstream(folder / name) << "x";
  EXPECT_EQ(sequence_in(folder.path()).value(), folder / "n.####.exr");
  EXPECT_EQ(sequence_around(folder / "n.-001.exr").value().frame, -1);
}

TEST(Pattern, FramesBeforeZeroAsBlenderWritesThem) {
  const TemporaryFolder folder;
  for (const char* name : {"n.-0002.exr", "n.-0001.exr", "n.0000.exr", "n.0001.exr"})
    std::ofstream(folder / name) << "x";
  EXPECT_EQ(sequence_in(folder.path()).value(), folder / "n.####.exr");
  const Pattern pattern = parse_pattern((folder / "n.####.exr").string()).value();
  LeftOut others;
  const auto found = find_frames(pattern, std::nullopt, &others).value();
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0].frame, -2);
  EXPECT_EQ(found[0].file, folder / "n.-0002.exr");
  EXPECT_EQ(others.files, 0u);
  EXPECT_EQ(find_frames(pattern, std::vector<int>{-1}).value()[0].file, folder / "n.-0001.exr");
  EXPECT_EQ(find_frames(pattern, std::vector<int>{-7}).value()[0].file, folder / "n.-007.exr");
  for (const int frame : {-2, -1}) {
    const auto around = sequence_around(pattern.file_with_sign(frame));
    ASSERT_TRUE(around);
    EXPECT_EQ(around->frame, frame);
    EXPECT_EQ(around->pattern, folder / "n.####.exr");
  }
  // Both spellings of one number: C's is the frame.
  std::ofstream(folder / "n.-002.exr") << "x";
  const auto twins = find_frames(pattern, std::nullopt, &others).value();
  ASSERT_EQ(twins.size(), 4u);
  EXPECT_EQ(twins[0].file, folder / "n.-002.exr");
  EXPECT_EQ(others.first, folder / "n.-0002.exr");
}

TEST(Pattern, FilesThatAreLeftOutAreNamed) {
  const TemporaryFolder folder;
  for (const char* name : {"f.1.exr", "f.2.exr", "f.10.exr", "f.0003.exr", "f.2147483648.exr", "f.20261122001.exr",
                           "f.1a.exr", "f.exr", "g.7.exr"})
    std::ofstream(folder / name) << "x";
  LeftOut others;
  const auto found = find_frames(parse_pattern((folder / "f.#.exr").string()).value(), std::nullopt, &others).value();
  EXPECT_EQ(found.size(), 3u);
  EXPECT_EQ(others.files, 3u);
  EXPECT_EQ(others.first, folder / "f.0003.exr");
  const auto none = find_frames(parse_pattern((folder / "g.##.exr").string()).value(), std::nullopt);
  EXPECT_THAT(none.error().message, HasSubstr("no file matches this pattern: it has 2 digits, and g.7.exr has 1"));
  std::filesystem::create_directory(folder / "dates");
  std::ofstream(folder / "dates/d.20261122001.exr") << "x";
  EXPECT_THAT(sequence_in(folder / "dates").error().message,
              HasSubstr("no numbered pictures: d.20261122001.exr has more than 9 digits"));
}

/// Files from macOS have letters and marks apart, and lie beside others that were written here.
TEST(Pattern, LettersAreTheSameHoweverTheyAreWritten) {
  const TemporaryFolder folder;
  const std::string apart = "Ku\u0308che.", together = "K\u00fcche.";
  for (const std::string& name : {apart + "0001.exr", apart + "0002.exr", together + "0003.exr"})
    std::ofstream(folder / name) << "x";
  for (const std::string& written : {apart, together}) {
    const Pattern pattern = parse_pattern((folder / (written + "####.exr")).string()).value();
    const auto found = find_frames(pattern, std::nullopt).value();
    ASSERT_EQ(found.size(), 3u) << written;
    EXPECT_EQ(found[0].file, folder / (apart + "0001.exr"));
    EXPECT_EQ(found[2].file, folder / (together + "0003.exr"));
    EXPECT_EQ(find_frames(pattern, std::vector<int>{2}).value()[0].file, folder / (apart + "0002.exr"));
    EXPECT_EQ(find_frames(pattern, std::vector<int>{3}).value()[0].file, folder / (together + "0003.exr"));
    EXPECT_EQ(find_frames(pattern, std::vector<int>{9}).value()[0].file, folder / (written + "0009.exr"));
  }
  EXPECT_EQ(sequence_in(folder / "").value(), folder / (apart + "####.exr"));
}

TEST(Pattern, AFrameHasItsSequenceAroundIt) {
  const TemporaryFolder folder;
  for (const char* name :
       {"s.0001.exr", "s.0002.exr", "s.0007.exr", "n_9.exr", "n_10.exr", "100%_08.exr", "100%_09.exr", "still.exr",
        "alone.0004.exr", "a.0005.txt", "a.0006.txt", "m.0003.exr", "m.0004.png"})
    std::ofstream(folder / name) << "x";
  const auto around = [&](const char* name) {
    const auto found = sequence_around(folder / name);
    if (!found) return std::string("none");
    EXPECT_EQ(parse_pattern(found->pattern).value().file(found->frame), folder / name);
    return std::filesystem::path(found->pattern).filename().string() + " " + std::to_string(found->frame);
  };
  EXPECT_EQ(around("s.0002.exr"), "s.####.exr 2");
  EXPECT_EQ(around("s.0001.exr"), "s.####.exr 1");
  EXPECT_EQ(around("n_9.exr"), "n_#.exr 9");
  EXPECT_EQ(around("n_10.exr"), "n_#.exr 10");
  EXPECT_EQ(around("100%_09.exr"), "100%%_##.exr 9");
  for (const char* name : {"still.exr", "alone.0004.exr", "a.0005.txt", "m.0003.exr", "s.0007.exr", "s.0003.exr"})
    EXPECT_EQ(around(name), "none") << name;
}

TEST(Pattern, PicturesOfOneSequenceAreOneInput) {
  const TemporaryFolder folder;
  for (const char* name : {"a.0001.exr", "a.0002.exr", "a.0003.exr", "still.exr"}) std::ofstream(folder / name) << "x";
  const auto file = [&](const char* name) { return (folder / name).string(); };
  EXPECT_EQ(in_sequences({file("a.0002.exr"), file("still.exr"), file("a.0003.exr")}),
            (std::vector<std::string>{file("a.####.exr"), file("still.exr")}));
}

TEST(Frames, AreReadBackAsTheyWereWritten) {
  for (const std::vector<int>& frames : {std::vector<int>{},
                                         {7},
                                         {1, 2, 3},
                                         {1, 3, 5, 7},
                                         {1, 5},
                                         {1, 2, 9, 12, 15, 16},
                                         {-3, -2, -1, 0},
                                         {5, 4, 3},
                                         {10, 20, 30, 31, 32, 2}}) {
    const std::string text = frames_text(frames);
    EXPECT_EQ(frames.empty() ? std::vector<int>{} : parse_frames(text).value(), frames) << text;
  }
  EXPECT_EQ(frames_text({1, 2, 3, 4}), "1-4");
  EXPECT_EQ(frames_text({1, 3, 5}), "1-5x2");
}

}  // namespace
}  // namespace afterglow
