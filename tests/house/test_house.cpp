// Rules of the house that a compiler does not check.
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <set>
#include <string>
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
    const auto words = words_of(read_file(file).value());
    for (const auto& effect : effects) EXPECT_FALSE(words.contains(effect)) << file << " names '" << effect << "'";
  }
  EXPECT_GT(files, 100);
}

/// The rooms in order; each uses only those before it (CONTRIBUTING.md).
TEST(House, RoomsUseOnlyRoomsAboveThem) {
  const std::vector<std::string> rooms{"core",    "image",     "gpu",   "shader", "graph", "script", "exec",
                                       "session", "reference", "bench", "stress", "play",  "window", "apps"};
  for (std::size_t room = 0; room < rooms.size(); ++room) {
    for (const auto& file : files_below(kProject / "engine" / rooms[room], {".h", ".cpp"})) {
      const std::string text = read_file(file).value();
      for (std::size_t below = room + 1; below < rooms.size(); ++below)
        EXPECT_EQ(text.find("#include \"" + rooms[below] + "/"), std::string::npos) << file << " uses " << rooms[below];
    }
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

}  // namespace
}  // namespace afterglow
