// SPDX-License-Identifier: MIT
// The documents as a site: every page is made, and every link leads somewhere.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "core/file.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;

const fs::path kProjectFolder = AFTERGLOW_PROJECT_FOLDER;

class Site : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    std::string pattern = (fs::temp_directory_path() / "afterglow-site-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    const std::string command = "'" + (kProjectFolder / "docs" / "site.sh").string() + "' '" + folder_.string() + "'";
    made_ = std::system(command.c_str()) == 0;
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }
  void SetUp() override { ASSERT_TRUE(made_) << "docs/site.sh failed (is cmark-gfm installed?)"; }

  static std::vector<fs::path> pages() {
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      if (entry.path().extension() == ".html") found.push_back(entry.path());
    return found;
  }

  /// What stands in an attribute, over the whole page.
  static std::vector<std::string> all(const std::string& text, const std::string& attribute) {
    static std::map<std::string, std::regex> expressions;
    const auto& expression = expressions.try_emplace(attribute, "[ <]" + attribute + "=\"([^\"]*)\"").first->second;
    std::vector<std::string> found;
    for (std::sregex_iterator it(text.begin(), text.end(), expression), end; it != end; ++it)
      found.push_back((*it)[1].str());
    return found;
  }

  inline static fs::path folder_;
  inline static bool made_ = false;
};

TEST_F(Site, EveryDocumentIsAPage) {
  for (const auto& entry : fs::recursive_directory_iterator(kProjectFolder / "docs"))
    if (entry.path().extension() == ".md") {
      auto page = folder_ / fs::relative(entry.path(), kProjectFolder);
      EXPECT_TRUE(fs::exists(page.replace_extension(".html"))) << page << ": add it to the pages of docs/site.sh";
    }
  for (const char* page : {"index.html", "README.html", "CONTRIBUTING.html", "CHANGELOG.html"})
    EXPECT_TRUE(fs::exists(folder_ / page)) << page;
}

TEST_F(Site, NoLinkIsDead) {
  int followed = 0;
  for (const auto& page : pages()) {
    if (page.filename() == "bench.html") continue;  // makes its own content
    const std::string text = read_file(page).value();
    auto links = all(text, "href");
    for (const auto& shown : all(text, "src")) links.push_back(shown);
    for (const auto& link : links) {
      if (link.find("://") != std::string::npos || link.starts_with("mailto:")) continue;
      const std::size_t mark = link.find('#');
      const std::string file = link.substr(0, mark), place = mark == std::string::npos ? "" : link.substr(mark + 1);
      const fs::path target = file.empty() ? page : (page.parent_path() / file).lexically_normal();
      ++followed;
      if (!fs::is_regular_file(target)) {
        ADD_FAILURE() << fs::relative(page, folder_) << " links " << link << ", which is not there";
        continue;
      }
      if (place.empty()) continue;
      const auto ids = all(read_file(target).value(), "id");
      EXPECT_NE(std::find(ids.begin(), ids.end(), place), ids.end())
          << fs::relative(page, folder_) << " links " << link << ": there is no such heading";
    }
  }
  EXPECT_GT(followed, 100);
}

/// What the reference of effects says of one.
std::string section_of(const std::string& text, const std::string& effect) {
  const std::string heading = "\n## " + effect + "\n";
  const std::size_t begin = text.find(heading);
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find("\n## ", begin + heading.size()) - begin);
}

TEST(Documents, EveryEffectHasItsPlaceInTheReference) {
  const std::string text = read_file(kProjectFolder / "docs" / "effects.md").value();
  int effects = 0;
  for (const auto& entry : fs::directory_iterator(kProjectFolder / "scripts" / "effects")) {
    const std::string name = entry.path().stem().string(), section = section_of(text, name);
    ++effects;
    ASSERT_FALSE(section.empty()) << name << " is not in docs/effects.md; run docs/effects/make.sh";
    EXPECT_NE(section.find("\nCost: "), std::string::npos) << name;
    EXPECT_NE(section.find("](images/effects/" + name + ".jpg "), std::string::npos) << name;
    EXPECT_TRUE(fs::exists(kProjectFolder / "docs/images/effects" / (name + ".jpg"))) << name;
    EXPECT_NE(section.find("```lua\nfx." + name), std::string::npos) << name << ": no example";
    // Formula or source stand in the comment that the effect's file begins with.
    EXPECT_TRUE(read_file(entry.path()).value().starts_with("-- ")) << name << " does not say where it comes from";
    // Every setting that the file declares by name has its row.
    const std::string script = read_file(entry.path()).value();
    static const std::regex setting("\n    ([a-z_0-9]+) = fx\\.[a-z0-9]+ ?\\{");
    for (std::sregex_iterator it(script.begin(), script.end(), setting), end; it != end; ++it)
      EXPECT_NE(section.find("| `" + (*it)[1].str() + "` |"), std::string::npos) << name << "." << (*it)[1];
  }
  EXPECT_GE(effects, 28);
}

}  // namespace
}  // namespace afterglow
