// SPDX-License-Identifier: MIT
// Time codes as text and bits, and counted on against numbers that are gone through one by one.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "image/time_code.h"

namespace afterglow {
namespace {

TEST(TimeCode, IsTextThatIsReadBack) {
  EXPECT_EQ(time_code_text(0x01020304), "01:02:03:04");
  EXPECT_EQ(time_code_text(0x23595929), "23:59:59:29");
  EXPECT_EQ(time_code_text(0x01020344), "01:02:03;04") << "frames are dropped";
  EXPECT_EQ(time_code_text(0xc1828384), "01:02:03:04") << "bits of fields and groups are none of the time";
  for (const std::uint32_t wrong : {0x24000000u, 0x00600000u, 0x00006000u, 0x0a000000u, 0xffffffffu})
    EXPECT_EQ(time_code_text(wrong), "") << wrong;
  for (const std::uint32_t code : {0u, 0x01020304u, 0x23595929u, 0x10000029u, 0x01020344u})
    EXPECT_EQ(time_code_of(time_code_text(code)), code);
  for (const char* wrong : {"", "01:02:03", "24:00:00:00", "01:60:00:00", "01:02:03:40", "01-02-03-04", "-1:02:03:04",
                            "01:02:03:4 ", "01:02:03:044"})
    EXPECT_FALSE(time_code_of(wrong)) << wrong;
}

/// The next number, by the words of SMPTE 12M: the first two (four) of each minute are left out, but for each tenth.
struct Counter {
  int nominal, dropped;
  int hours = 0, minutes = 0, seconds = 0, frames = 0;
  void next() {
    if (++frames < nominal) return;
    frames = 0;
    if (++seconds == 60) seconds = 0, ++minutes;
    if (seconds == 0 && minutes % 10 != 0) frames = dropped;
    if (minutes == 60) minutes = 0, hours = (hours + 1) % 24;
  }
  std::string text() const {
    return fmt::format("{:02}:{:02}:{:02}{}{:02}", hours, minutes, seconds, dropped > 0 ? ';' : ':', frames);
  }
};

TEST(TimeCode, IsCountedOn) {
  struct Way {
    Rational rate;
    Counter counter;
  };
  for (const Way& way :
       {Way{{24, 1}, {24, 0}}, Way{{24000, 1001}, {24, 0}}, Way{{25, 1}, {25, 0}}, Way{{30000, 1001}, {30, 2}},
        Way{{30000, 1001}, {30, 0}}, Way{{60000, 1001}, {60, 4}}, Way{{60, 1}, {60, 0}}}) {
    Counter counter = way.counter;
    const std::string first = counter.text();
    for (int frame = 0; frame < 100'000; ++frame, counter.next()) {
      ASSERT_EQ(time_code_after(first, frame, way.rate), counter.text()) << frame;
      if (frame % 1999 == 0) {
        ASSERT_EQ(time_code_after(counter.text(), -frame, way.rate), first) << frame;
      }
    }
  }
  EXPECT_EQ(time_code_after("01:00:00;00", 107'892, {30000, 1001}), "02:00:00;00");
  EXPECT_EQ(time_code_after("23:59:59:23", 1, {24, 1}), "00:00:00:00") << "the next day";
  EXPECT_EQ(time_code_after("00:00:00;00", -1, {30000, 1001}), "23:59:59;29");
}

TEST(TimeCode, IsNotCountedOnFromWhatIsNone) {
  for (const char* wrong : {"", "01:02:03", "24:00:00:00", "00:60:00:00", "00:00:00:24", "xx:00:00:00", "00:00:00;00"})
    EXPECT_EQ(time_code_after(wrong, 1, {24, 1}), "") << wrong;
  EXPECT_EQ(time_code_after("00:01:00;01", 1, {30, 1}), "") << "a number that is left out";
  EXPECT_EQ(time_code_after("00:00:00:00", 1, {0, 1}), "");
}

}  // namespace
}  // namespace afterglow
