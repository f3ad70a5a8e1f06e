// SPDX-License-Identifier: MIT
// What the documents print works as it stands there.
#include <sstream>

#include "cli_test.h"

namespace afterglow::test {
namespace {

class Printed : public CliTest {
 protected:
  /// The texts between ``` lines that name one of these languages.
  std::vector<std::string> blocks(const std::string& document) const {
    std::istringstream lines(read(AFTERGLOW_PROJECT_FOLDER "/docs/" + document));
    std::vector<std::string> out;
    bool within = false;
    for (std::string line; std::getline(lines, line);) {
      const bool mark = line.starts_with("```");
      if (mark && !within && (line == "```lua" || line == "```glsl")) {
        out.emplace_back();
        within = true;
      } else if (mark) {
        within = false;
      } else if (within) {
        out.back() += line + "\n";
      }
    }
    return out;
  }
};

/// The first effect that somebody writes: its files are named in their first lines.
TEST_F(Printed, TheFirstEffectIsFusedAsThePageSays) {
  const auto found = blocks("writing_effects.md");
  ASSERT_GT(found.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t space = found[i].find(' ');
    write(found[i].substr(space + 1, found[i].find('\n') - space - 1), found[i]);
  }
  EXPECT_THAT(files(),
              ::testing::IsSupersetOf({"effects/dim_corners.lua", "my_look.lua", "shaders/dim_corners/dim.glsl"}));
  const Outcome checked = run({"check", "my_look.lua"});
  EXPECT_EQ(checked.exit_code, kDone) << checked.err;
  EXPECT_THAT(checked.out, HasSubstr("2 effects, 2 passes in 1 kernel: no errors\n"));
  EXPECT_THAT(run({"explain", "my_look.lua"}).out, ContainsRegex("dim_corners\\.dim +pixel .*fused"));
  // The other kind, in its place.
  ASSERT_THAT(found[3], HasSubstr("sample_at"));
  write("shaders/dim_corners/dim.glsl", found[3] + "uniform float strength;\nuniform vec3 corner_color;\n");
  EXPECT_THAT(run({"check", "my_look.lua"}).out, HasSubstr("2 passes in 2 kernels"));
}

TEST_F(Printed, WholePresetsOfThePageOfCompositionAreRight) {
  int presets = 0;
  for (const std::string& block : blocks("composition.md")) {
    if (block.find("\nreturn fx.") == std::string::npos && !block.starts_with("return fx.")) continue;
    ++presets;
    write("look.lua", "local fx = require \"afterglow\"\n" + block);
    const Outcome checked = run({"check", "look.lua"});
    EXPECT_EQ(checked.exit_code, kDone) << block << checked.err;
  }
  EXPECT_GE(presets, 5);
}

}  // namespace
}  // namespace afterglow::test
