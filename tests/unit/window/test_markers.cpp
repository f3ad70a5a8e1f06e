// SPDX-License-Identifier: MIT
// Markers of frames, and which frames of a timeline have numbers.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/file.h"
#include "window/markers.h"
#include "window/timeline_ruler.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class MarkersTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("afterglow-markers-" + std::to_string(::getpid()) + "-" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Footage looks at names alone.
  void touch(const std::string& shot, int first, int last) {
    for (int number = first; number <= last; ++number)
      std::ofstream(folder_ / fmt::format("{}.{:04}.exr", shot, number)) << "x";
  }
  std::shared_ptr<const Footage> open(std::vector<std::string> inputs, const std::string& frames = "") {
    for (std::string& input : inputs) input = (folder_ / input).string();
    Diagnostics nowhere;
    return Footage::open({.inputs = std::move(inputs), .frames = frames, .read = {}}, nowhere).value();
  }
  static std::vector<int> positions(const Markers& markers) {
    std::vector<int> out;
    for (const Marker& marker : markers.all()) out.push_back(marker.position);
    return out;
  }
  fs::path kept() const { return folder_ / "state"; }

  fs::path folder_;
};

TEST_F(MarkersTest, AreSetNamedVisitedAndTakenAway) {
  touch("a", 1001, 1020);
  Markers markers(kept());
  markers.follow(open({"a.####.exr"}));
  EXPECT_THAT(markers.all(), IsEmpty());
  EXPECT_TRUE(markers.toggle(3).value());
  ASSERT_TRUE(markers.name(9, "  the cut\nhere "));
  EXPECT_TRUE(markers.toggle(15).value());
  EXPECT_THAT(positions(markers), ElementsAre(3, 9, 15));
  EXPECT_EQ(markers.at(9)->name, "the cut here");
  EXPECT_EQ(markers.next(3)->position, 9);
  EXPECT_EQ(markers.previous(9)->position, 3);
  EXPECT_EQ(markers.next(15), std::nullopt);
  EXPECT_EQ(markers.previous(3), std::nullopt);
  EXPECT_FALSE(markers.toggle(9).value());
  EXPECT_EQ(markers.at(9), std::nullopt);
  EXPECT_THAT(positions(markers), ElementsAre(3, 15));
}

TEST_F(MarkersTest, AreKeptWithTheFrameOfTheirClip) {
  touch("a", 1001, 1010);
  touch("b", 1001, 1005);
  {
    Markers markers(kept());
    markers.follow(open({"a.####.exr"}));
    ASSERT_TRUE(markers.name(4, "Ärger & \"Worte\""));
  }
  Markers again(kept());
  again.follow(open({"b.####.exr", "a.%04d.exr"}));  // behind another one, and written another way
  EXPECT_THAT(positions(again), ElementsAre(9));
  EXPECT_EQ(again.at(9)->name, "Ärger & \"Worte\"");
  EXPECT_EQ(again.at(4), std::nullopt) << "the same number in another clip";

  touch("a", 998, 1000);  // frames come before it
  again.follow(open({"a.####.exr"}));
  EXPECT_THAT(positions(again), ElementsAre(7));
  again.follow(open({"a.####.exr"}, "1001-1003"));
  EXPECT_THAT(again.all(), IsEmpty());

  again.follow(open({"a.####.exr"}));
  EXPECT_FALSE(again.toggle(7).value());
  EXPECT_TRUE(fs::is_empty(kept())) << "a clip without markers leaves no file";
}

TEST_F(MarkersTest, FilesThatAreBrokenOrCannotBeWrittenAreNoEnd) {
  touch("a", 1001, 1010);
  const auto footage = open({"a.####.exr"});
  Markers markers(kept());
  const auto file = markers.file(footage->clips()[0].key);
  fs::create_directories(file.parent_path());
  std::ofstream(file) << footage->clips()[0].key << "\n1003 good\nnonsense\n99999999999999 much\n1004x\n1005\n";
  markers.follow(footage);
  EXPECT_THAT(positions(markers), ElementsAre(2, 4));
  std::ofstream(file) << "/another/clip\n1003 good\n";
  Markers others(kept());
  others.follow(footage);
  EXPECT_THAT(others.all(), IsEmpty());

  std::ofstream(folder_ / "a_file") << "x";
  Markers nowhere(folder_ / "a_file" / "below");
  nowhere.follow(footage);
  const auto failed = nowhere.toggle(1);
  ASSERT_FALSE(failed);
  EXPECT_THAT(failed.error().text(), HasSubstr("a_file"));
  EXPECT_THAT(positions(nowhere), ElementsAre(1)) << "it holds until the end";
  Markers without{fs::path()};
  without.follow(footage);
  EXPECT_TRUE(without.toggle(1).value());
}

TEST_F(MarkersTest, OfTwoWindowsBothStay) {
  touch("a", 1001, 1020);
  Markers one(kept()), other(kept());
  for (Markers* markers : {&one, &other}) markers->follow(open({"a.####.exr"}));
  EXPECT_TRUE(one.toggle(5).value());
  EXPECT_TRUE(other.toggle(9).value());
  EXPECT_THAT(positions(other), ElementsAre(5, 9));
  EXPECT_FALSE(one.toggle(5).value());
  EXPECT_THAT(positions(one), ElementsAre(9));
  EXPECT_TRUE(one.toggle(2).value());
  EXPECT_FALSE(other.toggle(9).value());
  Markers later(kept());
  later.follow(open({"a.####.exr"}));
  EXPECT_THAT(positions(later), ElementsAre(2));
}

TEST_F(MarkersTest, NumbersOverTheTimelineNeverOverprint) {
  touch("a", 95, 1110);
  touch("b", 1, 7);
  for (const auto& footage : {open({"a.####.exr"}), open({"b.####.exr"}), open({"a.####.exr", "b.####.exr"}),
                              open({"b.####.exr", "a.####.exr", "b.####.exr"}), open({"a.####.exr"}, "95-1110x7")}) {
    for (const float width : {1.0f, 30.0f, 250.0f, 900.0f, 2000.0f}) {
      for (const float letter : {6.0f, 13.0f}) {
        const auto width_of = [&](const std::string& text) { return letter * static_cast<float>(text.size()); };
        const auto ticks = ruler_ticks(*footage, {width, 10, 5, width_of});
        float end = -10, x = -1e9f;
        int labels = 0;
        for (const RulerTick& tick : ticks) {
          EXPECT_GE(tick.x, x);
          EXPECT_LE(tick.x, width);
          x = tick.x;
          if (tick.label.empty()) continue;
          ++labels;
          EXPECT_GE(tick.label_x, end + 10 - 0.01f) << tick.label;
          end = tick.label_x + width_of(tick.label);
          EXPECT_LE(end, width + 0.01f) << tick.label;
          EXPECT_GE(tick.label_x, 0);
        }
        if (width >= 250) {
          EXPECT_GE(labels, width >= 900 ? 2 : 1) << width;
        }
        EXPECT_LE(static_cast<float>(ticks.size()), width / 4 + 4);
      }
    }
  }
}

TEST_F(MarkersTest, NumbersAreRound) {
  touch("a", 1001, 1100);
  const auto ticks = ruler_ticks(
      *open({"a.####.exr"}), {1000, 10, 5, [](const std::string& t) { return 7.0f * static_cast<float>(t.size()); }});
  std::vector<std::string> labels;
  for (const RulerTick& tick : ticks)
    if (!tick.label.empty()) labels.push_back(tick.label);
  EXPECT_THAT(labels, ElementsAre("1005", "1010", "1015", "1020", "1025", "1030", "1035", "1040", "1045", "1050",
                                  "1055", "1060", "1065", "1070", "1075", "1080", "1085", "1090", "1095", "1100"));
  EXPECT_EQ(ticks.size(), 100u);
  EXPECT_FLOAT_EQ(ticks.front().x, 5);  // the middle of frame 1001
}

TEST_F(MarkersTest, NumbersAreRoundBelowZeroToo) {
  for (int frame = -25; frame <= 25; ++frame)
    std::ofstream(folder_ / fmt::format("c.{}{:04}.exr", frame < 0 ? "-" : "", std::abs(frame)));
  const auto ticks = ruler_ticks(
      *open({"c.####.exr"}), {500, 10, 5, [](const std::string& t) { return 9.0f * static_cast<float>(t.size()); }});
  std::vector<std::string> labels;
  for (const RulerTick& tick : ticks)
    if (!tick.label.empty()) labels.push_back(tick.label);
  EXPECT_THAT(labels, ElementsAre("-25", "-20", "-15", "-10", "-5", "0", "5", "10", "15", "20", "25"));
}

}  // namespace
}  // namespace afterglow
