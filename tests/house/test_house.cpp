// SPDX-License-Identifier: MIT
// Rules of the house that a compiler does not check.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/file.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;

const fs::path kProject = AFTERGLOW_PROJECT_FOLDER;

std::vector<fs::path> files_below(const fs::path& folder, const std::set<std::string>& extensions) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (extensions.contains(entry.path().extension().string())) found.push_back(entry.path());
  return found;
}

std::set<std::string> words_of(const std::string& text) {
  std::set<std::string> words;
  std::string word;
  for (const char c : text + " ") {
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '_') {
      word += c;
    } else {
      if (!word.empty()) words.insert(word);
      word.clear();
    }
  }
  return words;
}

/// Words of the field that some rooms have for other things than the effect of that name: the exposure of the player's
/// view and of cameras in transfer curves, CDL files, curves over time and of encodings.
bool means_something_else(const std::string& room, const std::string& word) {
  static const std::set<std::pair<std::string, std::string>> kWords{
      {"image", "exposure"}, {"play", "exposure"}, {"window", "exposure"}, {"image", "cdl"},
      {"api", "curves"},     {"bench", "curves"},  {"image", "curves"},    {"script", "curves"}};
  return kWords.contains({room, word});
}

/// The text without the examples by which commands show how settings are written: they must work.
std::string without_examples(const std::string& room, std::string text) {
  if (room != "apps") return text;
  constexpr std::string_view kExample = "bloom.";
  for (std::size_t at = text.find(kExample); at != std::string::npos; at = text.find(kExample, at))
    text.erase(at, kExample.size());
  return text;
}

TEST(House, TheEngineKnowsNoEffectByName) {
  std::vector<std::string> effects;
  for (const auto& file : files_below(kProject / "scripts" / "effects", {".lua"}))
    effects.push_back(file.stem().string());
  ASSERT_FALSE(effects.empty());
  int files = 0;
  for (const auto& file : files_below(kProject / "engine", {".h", ".cpp", ".txt", ".in"})) {
    if (fs::relative(file, kProject / "engine").begin()->string() == "reference")
      continue;  // the oracles of tests and bench
    ++files;
    const std::string room = fs::relative(file, kProject / "engine").begin()->string();
    const auto words = words_of(without_examples(room, read_file(file).value()));
    for (const auto& effect : effects)
      if (words.contains(effect) && !means_something_else(room, effect))
        ADD_FAILURE() << file << " names '" << effect << "'";
  }
  EXPECT_GT(files, 100);
}

/// Headers of a room that files of other rooms include: its doors.
std::set<std::string> doors_of(const std::string& room) {
  std::set<std::string> doors;
  const std::string begin = "#include \"" + room + "/";
  for (const auto& file : files_below(kProject / "engine", {".h", ".cpp"})) {
    if (fs::relative(file, kProject / "engine").begin()->string() == room) continue;
    const std::string text = read_file(file).value();
    for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at + 1)) {
      const std::size_t from = at + begin.size();
      doors.insert(text.substr(from, text.find('"', from) - from));
    }
  }
  return doors;
}

/// What other rooms may know of a room is little (CONTRIBUTING.md). A header more is a decision: either it is made part
/// of one that is a door already, or a room is opened further, here.
TEST(House, RoomsHaveFewDoors) {
  struct Room {
    const char* name;
    std::size_t doors;
  };
  for (const auto& [name, most] :
       {Room{"image", 16}, Room{"gpu", 10}, Room{"shader", 4}, Room{"graph", 8}, Room{"script", 5}, Room{"edit", 2},
        Room{"exec", 6}, Room{"session", 6}, Room{"batch", 3}, Room{"farm", 5}, Room{"play", 6}, Room{"window", 2}}) {
    const auto doors = doors_of(name);
    EXPECT_LE(doors.size(), most) << name << " is opened by " << testing::PrintToString(doors);
  }
  EXPECT_TRUE(doors_of("exec").contains("renderer.h"));
}

/// The rooms in order; each uses only those before it (CONTRIBUTING.md).
TEST(House, RoomsUseOnlyRoomsAboveThem) {
  const std::vector<std::string> rooms{"core",  "image",  "gpu",     "shader", "graph", "script",
                                       "edit",  "exec",   "session", "batch",  "farm",  "reference",
                                       "bench", "stress", "play",    "window", "apps",  "api"};
  for (std::size_t room = 0; room < rooms.size(); ++room) {
    for (const auto& file : files_below(kProject / "engine" / rooms[room], {".h", ".cpp"})) {
      const std::string text = read_file(file).value();
      for (std::size_t below = room + 1; below < rooms.size(); ++below)
        EXPECT_EQ(text.find("#include \"" + rooms[below] + "/"), std::string::npos) << file << " uses " << rooms[below];
    }
  }
}

/// script/lua.h knows by which names the system's Lua is linked; Lua's own headers do not.
TEST(House, LuaIsIncludedInOnePlace) {
  for (const auto& file : files_below(kProject / "engine", {".h", ".cpp"})) {
    if (file.filename() == "lua.h") continue;
    const std::string text = read_file(file).value();
    for (const char* header : {"<lua.h>", "<lua.hpp>", "<lauxlib.h>", "<lualib.h>"})
      EXPECT_EQ(text.find(std::string("#include ") + header), std::string::npos) << file << " includes " << header;
  }
}

/// Newer CLI11 throws at names with these characters, before any command has begun.
TEST(House, NamesOfOptionsArePlain) {
  const std::string call = "add_option(";
  int names = 0;
  for (const auto& file : files_below(kProject / "engine" / "apps", {".cpp"})) {
    const std::string text = read_file(file).value();
    for (std::size_t at = text.find(call); at != std::string::npos; at = text.find(call, at + 1)) {
      const std::size_t first = text.find_first_not_of(" \n", at + call.size());
      if (text[first] != '"') continue;  // a name that a helper was given
      const std::string name = text.substr(first + 1, text.find('"', first + 1) - first - 1);
      EXPECT_EQ(name.find_first_of("=:{ !"), std::string::npos) << file << ": '" << name << "'";
      ++names;
    }
  }
  EXPECT_GT(names, 20);
}

/// The fuzzers are built with clang 14, which cannot compile the views and subranges of GCC 12's library.
TEST(House, ClangCompilesTheRanges) {
  for (const auto& file : files_below(kProject / "engine", {".h", ".cpp"})) {
    const std::string text = read_file(file).value();
    for (const char* name : {"ranges::stable_partition(", "ranges::partition(", "ranges::remove(", "ranges::remove_if(",
                             "ranges::unique(", "ranges::rotate(", "ranges::search(", "ranges::equal_range(",
                             "ranges::subrange", "std::views::", "ranges::views::"})
      EXPECT_EQ(text.find(name), std::string::npos) << file << " uses " << name;
  }
}

/// The comment that names the licence of a file, by the file's name; none where it needs none.
std::string licence_line(const fs::path& file) {
  static const std::map<std::string, std::string> kMarks{
      {".cpp", "//"}, {".h", "//"},   {".hpp", "//"}, {".c", "//"}, {".glsl", "//"}, {".frag", "//"}, {".vert", "//"},
      {".js", "//"},  {".inc", "//"}, {".lua", "--"}, {".py", "#"}, {".pyi", "#"},   {".cmake", "#"}, {".sh", "#"}};
  const std::string licence = " SPDX-License-Identifier: MIT";
  const std::string name = file.filename().string();
  if (name == "CMakeLists.txt" || name == "dev" || file.parent_path().filename() == ".ci") return "#" + licence;
  if (file.extension() == ".in") return (name.ends_with(".cpp.in") ? "//" : "#") + licence;
  const auto mark = kMarks.find(file.extension().string());
  return mark == kMarks.end() ? "" : mark->second + licence;
}

TEST(House, SourcesNameTheirLicence) {
  std::vector<fs::path> files{kProject / "CMakeLists.txt", kProject / "dev"};
  for (const char* folder : {".ci", "assets", "calibration", "cmake", "docs", "engine", "examples", "presets",
                             "scripts", "shaders", "tests", "tools"})
    for (const auto& entry : fs::recursive_directory_iterator(kProject / folder))
      if (entry.is_regular_file()) files.push_back(entry.path());
  int sources = 0;
  for (const auto& file : files) {
    // Findings of fuzzers stay byte for byte.
    const std::string name = fs::relative(file, kProject).string();
    const std::string line = licence_line(file);
    if (line.empty() || name.starts_with("tests/fuzz/found/") || name.starts_with("tests/fuzz/corpus/")) continue;
    ++sources;
    const std::string text = read_file(file).value();
    // A first line that programs read ("#!…", "---@meta") may stand above it.
    const bool below = text.starts_with("#!") || text.starts_with("---@meta");
    const std::size_t at = below ? text.find('\n') + 1 : 0;
    EXPECT_EQ(text.substr(at, text.find('\n', at) - at), line) << name << "; tools/license_tags.py writes the line";
  }
  EXPECT_GT(sources, 1000);
  EXPECT_TRUE(read_file(kProject / "LICENSE").value().starts_with("MIT License\n"));
}

/// The comment of a line, where it has one.
std::string comment_of(const std::string& line) {
  const std::size_t at = line.find("//");
  return at == std::string::npos ? "" : line.substr(at);
}

/// Headers of the system stand in angle brackets.
/// Licences are told of all that the program is built from; tools/package.sh puts their texts into the archive.
TEST(House, PackagesOfTheBuildAreNamed) {
  const std::string dev = read_file(kProject / "dev").value(), told = read_file(kProject / "THIRD_PARTY.md").value();
  const std::size_t begin = dev.find("BUILD_PACKAGES=(") + std::string_view("BUILD_PACKAGES=(").size();
  std::istringstream packages(dev.substr(begin, dev.find(')', begin) - begin));
  const std::set<std::string> tools{"g++", "cmake", "ninja-build", "ccache", "pkg-config"};
  int seen = 0;
  for (std::string package; packages >> package; ++seen)
    EXPECT_TRUE(tools.contains(package) || told.find("`" + package + "`") != std::string::npos)
        << "THIRD_PARTY.md: has no package `" << package << "`, which ./dev installs to build";
  EXPECT_GT(seen, 30);
}

TEST(House, CommentsNameFilesThatAreThere) {
  std::vector<std::string> files;
  for (const char* folder : {"docs", "engine", "examples", "shaders", "tests"})
    for (const auto& file : files_below(kProject / folder, {".h", ".md"})) files.push_back(file.string());
  for (const auto& entry : fs::directory_iterator(kProject)) files.push_back(entry.path().string());
  static const std::regex kName(R"([<\w./-]+\.(h|md)\b)");
  int names = 0;
  for (const auto& file : files_below(kProject / "engine", {".h", ".cpp"})) {
    std::istringstream text(read_file(file).value());
    for (std::string line; std::getline(text, line);) {
      const std::string comment = comment_of(line);
      for (std::sregex_iterator name(comment.begin(), comment.end(), kName), end; name != end; ++name) {
        if (name->str().starts_with("<")) continue;
        ++names;
        EXPECT_TRUE(std::ranges::any_of(files, [&](const auto& one) { return one.ends_with("/" + name->str()); }))
            << file << " names '" << name->str() << "': " << comment;
      }
    }
  }
  EXPECT_GT(names, 20);
}

/// So that an older program says what it is too old for.
TEST(House, PresetsNameTheOldestProgramThatRunsThem) {
  int presets = 0;
  for (const auto& file : files_below(kProject / "presets", {".lua"})) {
    const std::string text = read_file(file).value();
    if (text.find("return fx.effect") != std::string::npos) continue;
    ++presets;
    EXPECT_NE(text.find("\n  requires = \"0."), std::string::npos) << file;
  }
  EXPECT_GE(presets, 15);
}

/// Every library is on the page, and every function that the page names is in one of them, as it is there.
TEST(House, ThePageOfTheShaderLibraryIsTrue) {
  const std::string page = read_file(kProject / "docs" / "shader_library.md").value();
  std::string libraries;
  int files = 0;
  for (const auto& file : files_below(kProject / "shaders" / "lib", {".glsl"})) {
    libraries += " " + read_file(file).value();
    if (file.stem() == "prelude") continue;
    ++files;
    EXPECT_NE(page.find("`lib/" + file.filename().string() + "`"), std::string::npos) << file;
  }
  EXPECT_GT(files, 20);
  int functions = 0;
  const std::regex signature("`(\\w+ (\\w+)\\([^`]*\\))`");
  for (std::sregex_iterator it(page.begin(), page.end(), signature), end; it != end; ++it) {
    if ((*it)[2].str().find("NAME") != std::string::npos) continue;
    ++functions;
    EXPECT_NE(libraries.find("\n" + (*it)[1].str() + " {"), std::string::npos) << (*it)[1];
  }
  EXPECT_GT(functions, 40);
}

}  // namespace
}  // namespace afterglow
