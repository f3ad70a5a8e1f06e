// SPDX-License-Identifier: MIT
// A device, and what it takes to run a stack on it pass by pass and to compare each image with the oracle's.
#pragma once

#include <gmock/gmock.h>

#include <map>
#include <string>
#include <vector>

#include "exec/program.h"
#include "gpu/device.h"
#include "graph/graph.h"
#include "pictures.h"
#include "reference/double_image.h"
#include "script/preset.h"

namespace afterglow {

/// What one run of a stack made.
struct Made {
  Graph graph;
  Size size;
  std::vector<float> result;  ///< RGBA
  std::map<std::string, std::vector<float>>
      images;  ///< RGBA by pass ("bloom.up[0]"); only of runs with every pass on its own
  std::uint64_t clamped = 0;
  std::size_t kernels = 0;     ///< how many the passes were fused into
  std::size_t dispatches = 0;  ///< those of them that ran as workgroups

  bool ran() const { return graph.result != graph.source; }
  bool has(const std::string& pass) const { return images.count(pass) != 0; }
  /// An image as the device left it. The pass must exist.
  reference::DoubleImage image(const std::string& pass) const;
  const std::vector<float>& pixels(const std::string& pass) const { return images.at(pass); }
  Size size_of(const std::string& pass) const;
};

/// `plain`: every pass on its own in full floats, all images kept. `fused`: as users run it. `computed`: the same,
/// with compute shaders for passes that have them.
enum class Way { plain, fused, fused_half, computed, dispatched };

/// Runs the stack `{ ENTRIES }`, Lua text. Failures of any step fail the test. `length_scale`: see BuildContext.
Made run_stack(const std::string& entries, const Scene& scene, Way way, double length_scale = 1);
/// The same for a preset's file.
Made run_preset(const std::filesystem::path& preset, const Scene& scene, Way way, double length_scale = 1);
/// Error text of loading or building `{ ENTRIES }`; empty when there is none.
std::string build_error(const std::string& entries, const Scene& scene);

/// math.md §13: the measure |x − ref|/(|ref| + 0.01) over the first `channels` channels.
testing::AssertionResult agrees(const std::vector<float>& device, const reference::DoubleImage& expected,
                                double tolerance, int channels);
testing::AssertionResult all_finite(const std::vector<float>& pixels);
/// Bit for bit the source's.
testing::AssertionResult alpha_is_kept(const Made& made, const Scene& scene);

/// Tests of this folder: the validation layer has nothing to say.
class Effects : public testing::Test {
 protected:
  void TearDown() override;
};

inline constexpr double kFullFloat = 1e-5;  ///< tolerances of math.md §13
inline constexpr double kHalfFloat = 2e-3;
inline constexpr double kFused = 1e-6;  ///< between fused passes and plain ones
inline constexpr int kRgb = 3, kRgba = 4;

}  // namespace afterglow
