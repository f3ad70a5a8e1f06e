// SPDX-License-Identifier: MIT
// Sheets over the picture, with Dear ImGui alone.
#include <gtest/gtest.h>
#include <imgui_internal.h>

#include "window/interface.h"
#include "window/sheet.h"

namespace afterglow {
namespace {

class Sheets : public ::testing::Test {
 protected:
  struct Sheet {
    const char* name;
    ImVec2 at, pivot;
    const char* words;
  };
  /// As they lie when their sizes are known.
  std::vector<ImRect> places(const std::vector<Sheet>& sheets) {
    for (int frame = 0; frame < 4; ++frame) {
      interface_.begin({800, 600});
      for (const Sheet& sheet : sheets) {
        begin_sheet(sheet.name, sheet.at, sheet.pivot, interface_.ui(), 0);
        ImGui::TextUnformatted(sheet.words);
        end_sheet();
      }
      room_ = interface_.ui().sheets.free(0, 400, {0, 600});
      interface_.end();
    }
    std::vector<ImRect> out;
    for (const Sheet& sheet : sheets) out.push_back(ImGui::FindWindowByName(sheet.name)->Rect());
    return out;
  }
  Interface interface_{nullptr};
  SheetPlaces::Room room_;
};

TEST_F(Sheets, MakeWayAtTheTopAndAtTheBottom) {
  const auto at = places({{"state", {10, 10}, {0, 0}, "image: bloom.prefilter, which is long"},
                          {"frame", {200, 10}, {0.5f, 0}, "Frame 12 is missing"},
                          {"message", {200, 10}, {0.5f, 0}, "scope: histogram"},
                          {"error", {10, 590}, {0, 1}, "look.lua:3: error: and more words"},
                          {"probe", {10, 590}, {0, 1}, "12, 13"},
                          {"scopes", {240, 590}, {1, 1}, "histogram of the whole picture"}});
  for (std::size_t a = 0; a < at.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) EXPECT_FALSE(at[a].Overlaps(at[b])) << a << " and " << b;
  EXPECT_EQ(at[0].Min.y, 10) << "the first ones are where they want to be";
  EXPECT_EQ(at[3].Max.y, 590);
  EXPECT_GT(at[2].Min.y, at[1].Max.y);
  EXPECT_LT(at[5].Max.y, at[4].Min.y);
  EXPECT_GT(room_.top, at[2].Max.y);
  EXPECT_LT(room_.bottom, at[5].Min.y);
}

TEST_F(Sheets, WithRoomBesideEachOtherStayInARow) {
  const auto at = places({{"state", {10, 10}, {0, 0}, "left"},
                          {"message", {400, 10}, {0.5f, 0}, "middle"},
                          {"stats", {790, 10}, {1, 0}, "right"}});
  for (const ImRect& one : at) EXPECT_EQ(one.Min.y, 10);
}

TEST_F(Sheets, LargerThanTheWindowBeginAtItsCorner) {
  const auto at =
      places({{"scopes", {100, 100}, {1, 1}, "a\nb\nc\nd\ne\nf\ng\nh\ni\nj\nk\nl and a line that is far too wide"}});
  EXPECT_EQ(at[0].Min.x, 0);
  EXPECT_EQ(at[0].Min.y, 0);
}

}  // namespace
}  // namespace afterglow
