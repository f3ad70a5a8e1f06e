// SPDX-License-Identifier: MIT
// The transport bar: frames are gone to, ranges chosen, and its pieces lie beside each other.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "panel_test.h"
#include "window/transport_bar.h"

namespace afterglow::test {
namespace {

using ::testing::HasSubstr;

class TransportBar : public PanelTest {
 protected:
  TransportBar() : transport(100) {
    markers.follow(footage);
    what_ = [this] {
      TransportBarState state{
          .timeline = {transport, now, transport.position(), [](int at) { return at + 1001; },
                       [](int at) { return at < 50 ? FrameState::cached : FrameState::unread; }, *footage, markers},
          .view = look,
          .picture = {640, 360},
          .window = {640, 180}};
      draw_transport_bar(interface.ui(), state, {0, 0}, {wide, transport_bar_shape(interface.ui(), wide).height});
    };
    frame();
  }
  /// x of the middle of a position.
  static float x_of(int position) {
    const float padding = ImGui::GetStyle().WindowPadding.x;
    return padding + (static_cast<float>(position) + 0.5f) * (kWidth * 2 - 2 * padding) / 100;
  }
  /// Frames 1001 to 1100, by their names alone.
  static std::shared_ptr<const Footage> hundred_frames() {
    const auto folder = fs::temp_directory_path() / ("afterglow-bar-" + std::to_string(getpid()));
    fs::create_directories(folder);
    for (int number = 1001; number <= 1100; ++number) std::ofstream(folder / fmt::format("shot.{}.exr", number)) << "x";
    Diagnostics nowhere;
    auto opened = Footage::open({.inputs = {(folder / "shot.####.exr").string()}, .frames = {}, .read = {}}, nowhere);
    fs::remove_all(folder);
    return std::move(opened).value();
  }
  std::shared_ptr<const Footage> footage = hundred_frames();
  Markers markers{fs::path()};
  Transport transport;
  View look;
  float wide = kWidth * 2;
  double now = 0;
};

TEST_F(TransportBar, PlaysAndSteps) {
  ASSERT_TRUE(find({"Transport", "##play"}));
  click();
  EXPECT_TRUE(transport.playing());
  ASSERT_TRUE(find({"Transport", "##play"}));
  click();
  EXPECT_FALSE(transport.playing());
  ASSERT_TRUE(find({"Transport", "##on"}));
  click();
  EXPECT_EQ(transport.position(), 1);
  ASSERT_TRUE(find({"Transport", "##last"}));
  click();
  EXPECT_EQ(transport.position(), 99);
  EXPECT_THAT(words(), HasSubstr("1100  100/100"));
}

/// At any width nothing is drawn over anything else, and all of it within the bar.
TEST_F(TransportBar, PiecesNeverLieOnEachOther) {
  for (const float scale : {1.0f, 2.0f}) {
    interface.set_scale(scale);
    for (const float width : {500.0f, 524.0f, 724.0f, 880.0f}) {
      wide = width;
      frame();
      std::vector<ImGuiID> ids;
      const float height = 6 * 48;  // more than it ever has
      for (float y = 2; y < height; y += 3)
        for (float x = 2; x < width; x += 3) {
          move(x, y);
          frame();
          const ImGuiID id = ImGui::GetCurrentContext()->HoveredId;
          if (id != 0 && std::ranges::find(ids, id) == ids.end()) ids.push_back(id);
        }
      EXPECT_EQ(ids.size(), 12u) << "timeline, five buttons, six others; width " << width << ", scale " << scale;
    }
  }
}

TEST_F(TransportBar, ZoomAndFilter) {
  wide = kWidth;  // `find` looks no farther
  EXPECT_THAT(words(), HasSubstr("fit 50%"));
  ASSERT_TRUE(find({"Transport", "###zoom"}));
  click();
  EXPECT_FALSE(look.fit);
  EXPECT_EQ(look.zoom, 1);
  EXPECT_THAT(words(), HasSubstr("100%"));
  ASSERT_TRUE(find({"Transport", "###filter"}));
  click();
  EXPECT_TRUE(look.smooth);
  EXPECT_THAT(words(), HasSubstr("linear"));
}

TEST_F(TransportBar, Scrubs) {
  ASSERT_TRUE(find({"Transport", "scrub"}));
  move(x_of(40), ImGui::GetIO().MousePos.y);
  press(true);
  EXPECT_EQ(transport.position(), 40);
  move(x_of(71), ImGui::GetIO().MousePos.y);
  frame();
  EXPECT_EQ(transport.position(), 71);
  move(5000, 5000);
  frame();
  EXPECT_EQ(transport.position(), 99);
  press(false);
  move(x_of(3), 10);
  frame();
  EXPECT_EQ(transport.position(), 99);
}

TEST_F(TransportBar, RangesWithShift) {
  ASSERT_TRUE(find({"Transport", "scrub"}));
  const float y = ImGui::GetIO().MousePos.y;
  hold_shift(true);
  move(x_of(20), y);
  frame();
  press(true);
  press(false);
  move(x_of(60), y);
  frame();
  press(true);
  press(false);
  EXPECT_EQ(transport.first(), 20);
  EXPECT_EQ(transport.last(), 60);
  hold_shift(false);
  click(1);
  EXPECT_EQ(transport.first(), 0);
  EXPECT_EQ(transport.last(), 99);
}

TEST(PositionInBar, CoversEveryFrameEvenly) {
  EXPECT_EQ(position_in_bar(10, 10, 100, 10), 0);
  EXPECT_EQ(position_in_bar(19.9f, 10, 100, 10), 0);
  EXPECT_EQ(position_in_bar(20.1f, 10, 100, 10), 1);
  EXPECT_EQ(position_in_bar(109.9f, 10, 100, 10), 9);
  EXPECT_EQ(position_in_bar(-50, 10, 100, 10), 0);
  EXPECT_EQ(position_in_bar(500, 10, 100, 10), 9);
  EXPECT_EQ(position_in_bar(5, 0, 0, 10), 0);
}

}  // namespace
}  // namespace afterglow::test
