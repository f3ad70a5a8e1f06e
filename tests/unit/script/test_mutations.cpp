// SPDX-License-Identifier: MIT
// Broken scripts: presets and effects with random damage load or fail with one script error, and never crash or hang.
#include <gtest/gtest.h>

#include <random>

#include "core/file.h"
#include "scene.h"

using namespace std::string_literals;

namespace afterglow::test {
namespace {

// Cuts, doubles, swaps or replaces a piece of the text.
std::string damaged(std::string text, std::mt19937& random) {
  static const std::string pieces[] = {
      "{",   "}",    "(",   ")",    "=",  ",",    "nil",  "0/0",  "1e999", "function() end",
      "end", "\"",   "[[",  "--[[", "\n", "\x1B", "::",   "fx",   "g",     "setmetatable({}, {})",
      "-",   "\xFF", "\0"s, "#",    "..", "[1]",  "{{}}", "true", "s",     "while true do end"};
  const auto below = [&](std::size_t n) { return random() % std::max<std::size_t>(n, 1); };
  for (std::size_t i = 0, n = 1 + below(3); i < n && !text.empty(); ++i) {
    const std::size_t at = below(text.size()), length = 1 + below(12);
    switch (below(4)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, text.substr(below(text.size()), length));
        break;
      case 2:
        text.insert(at, pieces[below(std::size(pieces))]);
        break;
      default:
        text.replace(at, length, pieces[below(std::size(pieces))]);
    }
  }
  return text;
}

TEST(Mutations, EndInAGraphOrAScriptError) {
  const std::string effect = *read_file(AFTERGLOW_PROJECT_FOLDER "/scripts/effects/bloom.lua");
  const std::string preset = *read_file(AFTERGLOW_PROJECT_FOLDER "/presets/neon_night.lua");
  std::mt19937 random(20240607);
  int failed = 0, built = 0;
  Scene scene;
  scene.options.limits = {8u << 20, 500'000, 60};
  for (int i = 0; i < 400; ++i) {
    scene.preset(i % 2 ? damaged(preset, random) : preset);
    scene.write("effects/bloom.lua", i % 2 ? effect : damaged(effect, random));
    auto loaded = scene.load();
    if (!loaded) {
      EXPECT_EQ(loaded.error().kind, ErrorKind::script);
      EXPECT_FALSE(loaded.error().file.empty());
      EXPECT_EQ(loaded.error().text().find('\0'), std::string::npos);
      ++failed;
      continue;
    }
    auto graph = scene.build(*loaded);
    if (graph) {
      EXPECT_TRUE(validate(*graph)) << validate(*graph).error().text();
      ++built;
    } else {
      EXPECT_EQ(graph.error().kind, ErrorKind::script);
      ++failed;
    }
  }
  EXPECT_GT(failed, 100);
  EXPECT_GT(built, 10);
}

}  // namespace
}  // namespace afterglow::test
