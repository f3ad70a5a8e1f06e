// SPDX-License-Identifier: MIT
// Which line of a call an error points at.
#include <gtest/gtest.h>

#include "core/key_finder.h"

namespace afterglow::script {
namespace {

TEST(KeyFinder, KeysOfTheCall) {
  const char* text = "local x = {\n  a = 1,\n}\nfx.glow {\n  a = 1,\n  b = { a = 2 },\n  [\"c\"] = 3,\n}\n";
  EXPECT_EQ(line_of_key(text, 4, "glow", {"a"}), 5);
  EXPECT_EQ(line_of_key(text, 4, "glow", {"b"}), 6);
  EXPECT_EQ(line_of_key(text, 4, "glow", {"c"}), 7);
  EXPECT_EQ(line_of_key(text, 4, "glow", {"d"}), 4);
  EXPECT_EQ(line_of_key(text, 4, "glow", {}), 4);
}

TEST(KeyFinder, PathsAndPositions) {
  const char* text = "f {\n  \"one\",\n  deep = {\n    x = 1,\n    2,\n\n    3 },\n  [3] = 9,\n}";
  EXPECT_EQ(line_of_key(text, 1, "f", {"#1"}), 2);
  EXPECT_EQ(line_of_key(text, 1, "f", {"deep", "x"}), 4);
  EXPECT_EQ(line_of_key(text, 1, "f", {"deep", "#2"}), 7);
  EXPECT_EQ(line_of_key(text, 1, "f", {"deep", "y"}), 3);  // as near as it gets
  EXPECT_EQ(line_of_key(text, 1, "f", {"#3"}), 8);
}

TEST(KeyFinder, CommentsStringsAndFunctionsDoNotMislead) {
  const char* text =
      "f {\n  -- a = 1,\n  --[[ a = 2,\n  }]] s = \"} a = 3\", t = [==[ a = 4 ]] } ]==],\n"
      "  build = function(g, a)\n    local b, a = 1, 2\n    if a == 3 then a = 4 end\n    for i = 1, 2 do a = 5 end\n"
      "    repeat a = 6 until a\n    return { a = 7 }, (a), g[a]\n  end,\n  q = 'it\\'s', a = 8,\n}";
  EXPECT_EQ(line_of_key(text, 1, "f", {"a"}), 12);
}

TEST(KeyFinder, TheNamedCallOfALineWithSeveral) {
  const char* text = "return { g { k = 1 }, f({ z = 1,\n k = 2 }), { k = 3 } }";
  EXPECT_EQ(line_of_key(text, 1, "f", {"k"}), 2);
  EXPECT_EQ(line_of_key(text, 1, "g", {"k"}), 1);
  EXPECT_EQ(line_of_key("local make = fx.glow\nmake {\n\n bad = 1 }", 2, "glow", {"bad"}), 4);
}

TEST(KeyFinder, SecondCallOfTheNameOnALine) {
  EXPECT_EQ(line_of_key("f { a = 1 }, f {\n\n b = 2 }", 1, "f", {"b"}), 3);
}

TEST(KeyFinder, BrokenTextIsNoTrouble) {
  for (const char* text :
       {"", "f {", "f { a = ", "f { [", "f { [[", "f { \"", "f { a = \"\\", "}{", "f { --[[", "f(", "f({", "f { a"})
    EXPECT_EQ(line_of_key(text, 1, "f", {"k"}), 1) << text;
}

TEST(KeyFinder, ARepeatedKeyMeansItsLastPlace) { EXPECT_EQ(line_of_key("f {\n a = 1,\n a = 2 }", 1, "f", {"a"}), 3); }

TEST(RepeatedKeys, OfOneTableAreFound) {
  const auto found = [](std::string_view text) {
    std::string out;
    for (const auto& [key, first, line] : repeated_keys(text))
      out += (out.empty() ? "" : " ") + key + ":" + std::to_string(first) + ":" + std::to_string(line);
    return out;
  };
  EXPECT_EQ(found("fx.v { n = 1,\n m = 2,\n n = 3 }"), "n:1:3");
  EXPECT_EQ(found("fx.v { n = 1, ['n'] = 2 }"), "n:1:1");
  EXPECT_EQ(found("fx.v { n = 1, at = { n = 2 } }, fx.v { n = 3 }"), "");
  EXPECT_EQ(found("settings = {\n a = fx.int { min = 1,\n max = 2,\n min = 3 },\n a = 1 }"), "a:2:5 min:2:4");
  EXPECT_EQ(found("{ 1, 2, [1] = 3, [n] = 1, [n] = 2, -- n = 1\n n = '{ n = 2 }' }"), "");
  EXPECT_EQ(found("{ f = function() local n = 1; n = 2 end, n = 3, { n = n == 1, n == 2 } }"), "");
  EXPECT_EQ(found("fx.v { n = 1, n = 2"), "");
}

}  // namespace
}  // namespace afterglow::script
