// SPDX-License-Identifier: MIT
// docs/embedding.md shows code that is compiled and run: each block is part of a file of examples/, word by word.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <vector>

namespace afterglow::test {
namespace {
namespace fs = std::filesystem;

std::string read(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The words of a text, one space between them: how lines are broken does not matter.
std::string bare(const std::string& text) {
  std::istringstream words(text);
  std::string out;
  for (std::string word; words >> word;) out += word + " ";
  return out;
}

TEST(Document, EveryBlockIsPartOfAnExample) {
  std::map<std::string, std::string> examples;  // by the word behind the fence
  for (const auto& entry : fs::directory_iterator(AFTERGLOW_PROJECT_FOLDER "/examples")) {
    const std::string ending = entry.path().extension().string();
    const std::string language = entry.path().filename() == "CMakeLists.txt" ? "cmake"
                                 : ending == ".c"                            ? "c"
                                 : ending == ".cpp"                          ? "cpp"
                                 : ending == ".py"                           ? "python"
                                                                             : "";
    if (!language.empty()) examples[language] += " " + bare(read(entry.path()));
  }
  ASSERT_EQ(examples.size(), 4u);
  std::istringstream lines(read(AFTERGLOW_PROJECT_FOLDER "/docs/embedding.md"));
  std::map<std::string, int> blocks;
  std::string language, block;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("```")) {
      block += line + "\n";
      continue;
    }
    if (!language.empty()) {
      const auto example = examples.find(language);
      if (example != examples.end()) {
        ++blocks[language];
        EXPECT_NE(example->second.find(" " + bare(block)), std::string::npos) << block;
      }
      language.clear();
    } else {
      language = line.size() > 3 ? line.substr(3) : "text";
    }
    block.clear();
  }
  for (const auto& [name, text] : examples) EXPECT_GT(blocks[name], 0) << name;
}

}  // namespace
}  // namespace afterglow::test
