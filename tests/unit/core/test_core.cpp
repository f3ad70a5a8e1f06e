// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/diagnostics.h"
#include "core/file.h"
#include "core/filter.h"
#include "core/hash.h"
#include "core/inside.h"
#include "core/paths.h"
#include "core/result.h"
#include "core/text.h"
#include "core/utf8.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;

TEST(Error, PrintsOneLineWithPlaceAllowedAndNearest) {
  const Error error{ErrorKind::script, "unknown setting 'treshold'", "a.lua", 3, "threshold, knee", "threshold",
                    {"in bloom"}};
  EXPECT_EQ(
      error.text(),
      "a.lua:3: error: unknown setting 'treshold'; allowed: threshold, knee; did you mean 'threshold'?\n  in bloom");
  EXPECT_EQ((Error{ErrorKind::io, "is empty", "b.exr"}).text(), "b.exr: error: is empty");
  EXPECT_EQ(Error{.message = "plain"}.text(), "error: plain");
}

TEST(Error, TextsNeverReachTheTerminalAsEscapes) {
  Error error{ErrorKind::io,
              "layer 'a\x1b]0;owned\a\r\nb' \x7f",
              "x\x1b[2J.exr",
              3,
              "\t",
              "\xc2\x9b"
              "31m"};
  error.trail = {"in \x1b[1m"};
  EXPECT_EQ(error.text(), "x [2J.exr:3: error: layer 'a ]0;owned   b'  ; allowed:  ; did you mean ' 31m'?\n  in  [1m");
  EXPECT_EQ((Error{ErrorKind::io, "größer: 3×4 → …"}).text(), "error: größer: 3×4 → …");
  std::string shown;
  Diagnostics diagnostics([&](Severity, const std::string& text) { shown = text; });
  diagnostics.warn("one\x1b[2J\n  two");
  EXPECT_EQ(shown, "one [2J\n  two");
}

Result<int> half(int x) {
  if (x % 2) return Error{.message = "odd"};
  return x / 2;
}
Result<int> quarter(int x) {
  AFTERGLOW_TRY(const int h, half(x));
  return half(h);
}

TEST(Result, TryPassesErrorsOn) {
  EXPECT_EQ(quarter(8).value(), 2);
  EXPECT_EQ(quarter(6).error().message, "odd");
}

TEST(Text, NearestName) {
  const std::vector<std::string> names{"bloom", "box_bloom", "tone_mapping"};
  EXPECT_EQ(nearest_name("blom", names), "bloom");
  EXPECT_EQ(nearest_name("tonemapping", names), "tone_mapping");
  EXPECT_EQ(nearest_name("zzzzzz", names), "");
}

TEST(Text, PartsOfNamesAreEnough) {
  const std::vector<std::string> names{"film_grain", "tone_mapping", "color_adjustments", "color_blit", "blit"};
  EXPECT_EQ(nearest_name("tonemap", names), "tone_mapping");
  EXPECT_EQ(nearest_name("Grain", names), "film_grain");
  EXPECT_EQ(nearest_name("color", names), "color_blit");  // the shorter one
  EXPECT_EQ(nearest_name("to", names), "");
  EXPECT_EQ(nearest_name("ain", names), "");  // not where it begins
}

TEST(Text, TwoLettersChangedOverAreOneMistake) {
  const std::vector<std::string> names{"set", "run", "new"};
  EXPECT_EQ(nearest_name("rnu", names), "run");
  EXPECT_EQ(nearest_name("urn", names), "run");
  EXPECT_EQ(nearest_name("nur", names), "");  // the first and the third
}

TEST(Text, WhatIsLikeNothingHasNoNearestName) {
  EXPECT_EQ(nearest_name("cave.lua", std::vector<std::string>{"haze.lua"}), "");  // the ending is everybody's
  EXPECT_EQ(nearest_name("hase.lua", std::vector<std::string>{"haze.lua"}), "haze.lua");
  EXPECT_EQ(nearest_name("fast", std::vector<std::string>{"at"}), "");
  EXPECT_EQ(nearest_name("-", std::vector<std::string>{"q"}), "");
}

TEST(Text, NumbersReadBackShort) {
  EXPECT_EQ(number_text(0.2f), "0.2");
  EXPECT_EQ(number_text(0.2), "0.2");
  EXPECT_EQ(number_text(1e10), "10000000000");
  EXPECT_EQ(number_text(-15), "-15");
  EXPECT_EQ(number_text(0), "0");
  EXPECT_EQ(number_text(1e-50), "1e-50") << "0 as a float";
  EXPECT_EQ(number_text(-1e300), "-1e+300") << "no float";
}

TEST(Text, WhatIsNoUtf8IsReplaced) {
  for (const char* good : {"", "plain", "caf\u00E9", "\uD7FF\uE000\uFFFD", "\U00010000\U0010FFFF"})
    EXPECT_EQ(utf8_text(good), good);
  EXPECT_EQ(utf8_text("caf\xE9"), "caf\uFFFD");
  EXPECT_EQ(utf8_text("\xE9t\xE9"), "\uFFFDt\uFFFD");
  EXPECT_EQ(utf8_text("a\xF0\x9F\x98z"), "a\uFFFDz");  // a character that breaks off
  EXPECT_EQ(utf8_text("\x80\xFF"), "\uFFFD\uFFFD");    // no beginning
  EXPECT_EQ(utf8_text("\xC0\x80"), "\uFFFD\uFFFD");    // longer than it need be
  EXPECT_EQ(utf8_text("\xE0\x9F\xBF"), "\uFFFD\uFFFD\uFFFD");
  EXPECT_EQ(utf8_text("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD");            // a surrogate
  EXPECT_EQ(utf8_text("\xF4\x90\x80\x80"), "\uFFFD\uFFFD\uFFFD\uFFFD");  // above U+10FFFF
  EXPECT_EQ(utf8_text(std::string("a\0\xFFz", 4)), std::string("a\0\uFFFDz", 6));
}

TEST(Hash, BoundariesCount) {
  EXPECT_NE(Hasher().add("ab").add("c").finish(), Hasher().add("a").add("bc").finish());
  EXPECT_EQ(hash_text("x"), hash_text("x"));
  EXPECT_EQ(hash_text("x").hex().size(), 32u);
}

class Folder : public testing::Test {
 protected:
  fs::path folder_ = fs::temp_directory_path() / ("afterglow_core_" + std::to_string(getpid()));
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  int count() const { return static_cast<int>(std::distance(fs::directory_iterator(folder_), {})); }
};

TEST_F(Folder, WritesWholeFilesOrNothing) {
  ASSERT_TRUE(write_file_atomically(folder_ / "a.txt", "hello"));
  EXPECT_EQ(read_file(folder_ / "a.txt").value(), "hello");
  EXPECT_EQ(count(), 1);
  fs::create_directory(folder_ / "b.txt");
  std::ofstream(folder_ / "b.txt" / "inside") << "x";
  EXPECT_FALSE(write_file_atomically(folder_ / "b.txt", "hello"));
  EXPECT_EQ(count(), 2);
  EXPECT_EQ(write_file_atomically(folder_ / "none" / "a.txt", "x").error().kind, ErrorKind::io);
}

TEST_F(Folder, ReadErrorsSayWhy) {
  EXPECT_EQ(read_file(folder_ / "missing").error().message, "no such file");
  EXPECT_EQ(read_file(folder_).error().message, "is a folder, not a file");
  std::ofstream(folder_ / "big") << std::string(100, 'x');
  EXPECT_FALSE(read_file(folder_ / "big", 10));
}

TEST_F(Folder, MissingFilesNameWhatLiesThere) {
  for (const char* name : {"look.lua", "look.lua~", ".lokk.lua", "beauty.exr", "shot.0007.exr", "take1.exr"})
    std::ofstream(folder_ / name) << "x";
  const auto nearest = [&](const char* name) { return missing_file(folder_ / name).nearest; };
  EXPECT_EQ(nearest("lok.lua"), (folder_ / "look.lua").string());
  EXPECT_EQ(nearest("baeuty.exr"), (folder_ / "beauty.exr").string());
  EXPECT_EQ(nearest("beauty.png"), (folder_ / "beauty.exr").string());
  EXPECT_EQ(nearest("tkae1.exr"), (folder_ / "take1.exr").string());
  EXPECT_EQ(nearest("take2.exr"), "");      // another one
  EXPECT_EQ(nearest("shto.0007.exr"), "");  // a frame
  EXPECT_EQ(nearest("none/look.lua"), "");
  EXPECT_EQ(read_file(folder_ / "lok.lua").error().nearest, "");  // caches are read so
  EXPECT_EQ(read_named_file(folder_ / "look.lua").value(), "x");
  EXPECT_EQ(read_named_file(folder_ / "lok.lua").error().text(), (folder_ / "lok.lua").string() +
                                                                     ": error: no such file; did you mean '" +
                                                                     (folder_ / "look.lua").string() + "'?");
}

TEST_F(Folder, SearchPathPrefersTheUser) {
  fs::create_directories(folder_ / "user" / "effects");
  fs::create_directories(folder_ / "home" / "scripts" / "effects");
  std::ofstream(folder_ / "user" / "effects" / "bloom.lua") << "";
  std::ofstream(folder_ / "home" / "scripts" / "effects" / "bloom.lua") << "";
  const SearchPath path{{folder_ / "user"}, folder_ / "home"};
  const auto hits = path.find_effect("bloom");
  ASSERT_EQ(hits.size(), 2u);
  EXPECT_EQ(hits[0], folder_ / "user" / "effects" / "bloom.lua");
  EXPECT_TRUE(path.find_effect("glow").empty());
}

TEST_F(Folder, APackAroundAPresetIsOnItsPath) {
  const fs::path preset = folder_ / "look" / "presets" / "a.lua";
  fs::create_directories(preset.parent_path());
  EXPECT_THAT(folders_of_preset(preset), testing::ElementsAre(preset.parent_path()));
  for (const char* const part : {"effects", "shaders", "luts"}) {
    fs::create_directories(folder_ / "look" / part);
    EXPECT_THAT(folders_of_preset(preset), testing::ElementsAre(preset.parent_path(), folder_ / "look")) << part;
    fs::remove(folder_ / "look" / part);
  }
}

TEST(Diagnostics, WarnsOncePerKey) {
  int count = 0;
  Diagnostics diagnostics([&](Severity, const std::string&) { ++count; });
  diagnostics.warn_once("a", "x");
  diagnostics.warn_once("a", "y");
  diagnostics.warn_once("b", "z");
  EXPECT_EQ(count, 2);
}

TEST(Filter, TextTellsFiltersApart) {
  Filter a, b;
  EXPECT_EQ(a.text(), b.text());
  b.x = {{-1, .5}, {1, .5}};
  EXPECT_NE(a.text(), b.text());
}

TEST(Text, MarkupNamesWhatItsReadersTakeForTheirs) {
  EXPECT_EQ(markup_text("a < b && c > \"d\""), "a &lt; b &amp;&amp; c &gt; &quot;d&quot;");
  EXPECT_EQ(markup_text("1920×1080"), "1920×1080");
  EXPECT_EQ(markup_text("\xff&"), "\xEF\xBF\xBD&amp;") << "XML is UTF-8";
  EXPECT_EQ(markup_text("a\x1b[2J\nb\xE2\x80\xAE"), "a [2J\nb ");
}

TEST(Inside, TheOwnFolderOfAFileComesFirst) {
  using Paths = std::vector<std::filesystem::path>;
  const Paths folders{".", "packs/a", "packs/ab", "/share/scripts"};
  EXPECT_EQ(own_first(folders, "effects/e.lua"), folders);
  EXPECT_EQ(own_first(folders, "./effects/e.lua"), folders);
  EXPECT_EQ(own_first(folders, "packs/ab/effects/e.lua"), (Paths{"packs/ab", ".", "packs/a", "/share/scripts"}));
  EXPECT_EQ(own_first(folders, "/share/scripts/e.lua"), (Paths{"/share/scripts", ".", "packs/a", "packs/ab"}));
  EXPECT_EQ(own_first(folders, "../other/e.lua"), folders);
  EXPECT_EQ(own_first(folders, "/share/scripts2/e.lua"), folders);
  EXPECT_EQ(own_first({"a"}, "e.lua"), Paths{"a"});
}

}  // namespace
}  // namespace afterglow
