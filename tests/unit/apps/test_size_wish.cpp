// --size: both sides, one of them, or a share.
#include <gtest/gtest.h>

#include "batch/scale.h"

namespace afterglow {
namespace {

Size size_of(const std::string& text, Size picture = {1920, 1080}) { return parse_size_wish(text)->of(picture); }

TEST(SizeWish, KeepsTheShapeUnlessBothSidesAreGiven) {
  EXPECT_EQ(size_of("640x480"), (Size{640, 480}));
  EXPECT_EQ(size_of("640"), (Size{640, 360}));
  EXPECT_EQ(size_of("x720"), (Size{1280, 720}));
  EXPECT_EQ(size_of("640x"), (Size{640, 360}));
  EXPECT_EQ(size_of("50%"), (Size{960, 540}));
  EXPECT_EQ(size_of("33.3%"), (Size{639, 360}));
  EXPECT_EQ(size_of("0.01%"), (Size{1, 1}));
  EXPECT_EQ(size_of("1", {300, 7}), (Size{1, 1}));
}

TEST(SizeWish, RefusesWhatIsNoSize) {
  for (const char* text :
       {"", "x", "0", "0x5", "16385", "1.5", "640x360x2", "-4", "%", "0%", "-5%", "1601%", "5 %", "6y4"}) {
    const auto wish = parse_size_wish(text);
    ASSERT_FALSE(wish.ok()) << text;
    EXPECT_EQ(wish.error().allowed, "WIDTHxHEIGHT, WIDTH, xHEIGHT (1 to 16384) or a share like 50%");
  }
}

}  // namespace
}  // namespace afterglow
