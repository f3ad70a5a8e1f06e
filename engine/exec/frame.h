// SPDX-License-Identifier: MIT
// What goes into a frame, what comes out of it, and how long it took.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/hash.h"
#include "core/unset_vector.h"
#include "exec/program.h"
#include "graph/condition.h"

namespace afterglow {

struct KernelTime {
  std::string name;
  double milliseconds = 0;
};
struct FrameTimes {
  double upload = 0, execute = 0, readback = 0;  ///< milliseconds, wall clock
  double waited = 0;                             ///< of `execute`: in which the CPU had nothing else to do
  std::vector<KernelTime> kernels;               ///< empty unless asked for and known
  int kernels_run = 0, kernels_kept = 0;         ///< kept: what they made in an earlier run is still right
  bool separate_submissions = false;             ///< kernels were timed one submission each; not part of `execute`
};
enum class KernelTiming { none, timestamps, submissions };

/// One input of a frame in host memory: interleaved floats.
struct HostImage {
  const float* pixels = nullptr;
  Size size;
  int channels = 4;
  std::optional<Hash> content{};  ///< of the pixels, when known: an image of the same content is not uploaded again
  /// In place of `pixels`, for pictures that are stored otherwise: writes row y as floats. Called on several threads.
  std::function<void(int y, float* row)> read_row{};
};

struct HostResult {
  /// RGBA. It may be the very memory of the input "source": it is written after all inputs have been read. Vectors
  /// that are large enough already are not allocated again.
  std::vector<float> pixels;
  /// Instead of `pixels`, of a program with ProgramOptions::unorm8: RGBA. Empty behind others, whatever it held.
  UnsetVector<std::uint8_t> unorm8;
  std::uint64_t clamped = 0;  ///< half storage: source or result samples held at ±65504
  /// Of a program with ProgramOptions::flag_non_finite: some alpha is 0. Such a program's `pixels` have no other alpha.
  bool flagged = false;
  bool keep_alpha = false;  ///< write R, G and B alone where `pixels` has the size of the result already
  /// In place of `pixels` and `unorm8`: takes `width` pixels of row y, from column x on, as they lie in an image of
  /// `format` (RGBA32F, RGBA16F, RGBA8). Returns how many values were held at ±65504. Called on several threads.
  std::function<std::uint64_t(int x, int y, int width, VkFormat format, const std::byte* from)> write_row{};
};

/// An image of a Renderer between frames. It may be sampled in fragment shaders of later submissions to the device's
/// queue without a barrier, in this layout, and must be left in it.
struct DeviceImage {
  ImageBinding binding;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  const std::byte* pixels = nullptr;  ///< of images that the CPU may read in place between frames; else null
  std::size_t row_pitch = 0;          ///< of those, in bytes
};
struct DeviceImages {
  DeviceImage source, result;
  bool ran = false;  ///< false: nothing had to run, the result *is* the source
};

}  // namespace afterglow
