// SPDX-License-Identifier: MIT
// Every preset of the installation: it loads, runs as a whole, and the fused passes give what the plain ones give.
#include <algorithm>

#include "harness.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;
using namespace reference;

std::vector<fs::path> presets() {
  std::vector<fs::path> found;
  const fs::path folder = AFTERGLOW_PROJECT_FOLDER "/presets";
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const auto relative = fs::relative(entry.path(), folder).string();
    if (entry.path().extension() == ".lua" && relative.find("effects/") == std::string::npos)
      found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST_F(Effects, EveryPresetRuns) {
  EXPECT_GE(presets().size(), 8u);
  const auto scene = neon_scene({160, 90}, 560, 330);
  for (const auto& preset : presets()) {
    SCOPED_TRACE(preset.string());
    const Made plain = run_preset(preset, scene, Way::plain), fused = run_preset(preset, scene, Way::fused);
    EXPECT_TRUE(plain.ran());
    EXPECT_TRUE(plain.graph.skipped.empty()) << plain.graph.skipped[0].name << ": " << plain.graph.skipped[0].reason;
    EXPECT_TRUE(all_finite(fused.result));
    EXPECT_TRUE(alpha_is_kept(fused, scene));
    EXPECT_TRUE(agrees(fused.result, from_floats(plain.result.data(), plain.size, 4), kFused, kRgba));
    EXPECT_FALSE(agrees(fused.result, scene.source, 1e-2, kRgb)) << "the preset changes nothing";
  }
}

TEST_F(Effects, EveryPresetRunsWithoutDepthAndNormals) {
  auto scene = neon_scene({101, 57}, 700, 200);
  scene.depth.reset();
  scene.normal.reset();
  for (const auto& preset : presets()) EXPECT_TRUE(all_finite(run_preset(preset, scene, Way::fused).result)) << preset;
}

}  // namespace
}  // namespace afterglow
