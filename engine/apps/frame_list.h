// Which files a run reads and writes: inputs and outputs paired, before any of them is opened.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "image/reader.h"

namespace afterglow {

struct FrameJob {
  int frame = 1;
  std::filesystem::path input, output;
  LayerChoice depth, normal, motion;  ///< patterns resolved for this frame

  /// Every file that the output is made from.
  std::vector<std::filesystem::path> sources() const;
};

struct FrameListRequest {
  std::vector<std::string> inputs;  ///< files and patterns
  std::string output;               ///< file, pattern or folder
  std::string extension;            ///< --format, for outputs in a folder; empty: that of the input
  std::string frames;               ///< "1-24x2"; empty: all that exist
  LayerChoice depth, normal, motion;
};

/// Errors: usage (a plain output for several frames, two inputs for one output, an output that is an input), io
/// (nothing matches).
Result<std::vector<FrameJob>> list_frames(const FrameListRequest& request);

}  // namespace afterglow
