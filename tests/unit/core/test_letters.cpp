// SPDX-License-Identifier: MIT
// Letters with marks in both of their spellings, and text in UTF-16.
#include <gtest/gtest.h>

#include <string>

#include "core/decomposed.h"
#include "core/utf16.h"

namespace afterglow {
namespace {

TEST(Letters, AreTheSameInBothSpellings) {
  const struct {
    std::string together, apart;
  } kPairs[] = {
      {"Blu\u0308te", "Blu\u0308te"},   {"Bl\u00fcte", "Blu\u0308te"}, {"\u1ec7", "e\u0323\u0302"},
      {"\uac01", "\u1100\u1161\u11a8"}, {"\uac00", "\u1100\u1161"},    {"\u304c.0001.exr", "\u304b\u3099.0001.exr"},
      {"\u0439", "\u0438\u0306"},       {"plain.0001", "plain.0001"},  {"\xff\xfe broken", "\xff\xfe broken"}};
  for (const auto& [together, apart] : kPairs) {
    EXPECT_TRUE(same_letters(together, apart)) << together;
    EXPECT_EQ(taken_apart(together), apart);
    EXPECT_EQ(put_together(apart), put_together(together));
    EXPECT_EQ(taken_apart(put_together(apart)), apart);
  }
  EXPECT_EQ(put_together("Blu\u0308te"), "Bl\u00fcte");
  EXPECT_EQ(put_together("\u1100\u1161\u11a8"), "\uac01");
  EXPECT_FALSE(same_letters("\u00fc", "u"));
  EXPECT_FALSE(same_letters("\u00fc", "\u00f6"));
  EXPECT_FALSE(same_letters("A", "a"));
  EXPECT_EQ(taken_apart("\U0001f600\u20ac\xf0\x9f"), "\U0001f600\u20ac\xf0\x9f");
}

TEST(Letters, TextInUtf16IsKnown) {
  using namespace std::string_literals;
  EXPECT_TRUE(is_utf16("\xff\xfet\0"s));
  EXPECT_TRUE(is_utf16("\xfe\xff\0t"s));
  EXPECT_TRUE(is_utf16("T\0I\0T\0L\0E\0"s));
  EXPECT_TRUE(is_utf16("\0T\0I\0T\0L\0E"s));
  for (const std::string& other : {"TITLE \"a\""s, ""s, "T\0"s, "\0\0\0\0\0\0\0\0\0\0"s, "T\0\0\0I\0\0\0T\0"s})
    EXPECT_FALSE(is_utf16(other));
}

}  // namespace
}  // namespace afterglow
