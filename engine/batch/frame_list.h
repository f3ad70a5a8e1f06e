// SPDX-License-Identifier: MIT
// Which files a run reads and writes: inputs and outputs paired, before any of them is opened.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "image/reader.h"
#include "image/sequence.h"

namespace afterglow {

struct FrameJob {
  int frame = 1;
  std::filesystem::path input, output;
  LayerChoice depth, normal, motion;  ///< patterns resolved for this frame
  /// Frames of one sequence have the same: the pattern, or a file's name without its number.
  std::string sequence{};
  std::vector<std::filesystem::path> earlier{};  ///< files of earlier frames that the output depends on

  /// Every file that the output is made from.
  std::vector<std::filesystem::path> sources() const;
};

struct FrameListRequest {
  std::vector<std::string> inputs;  ///< files and patterns
  std::string output;               ///< file, pattern or folder; a video; "-": standard output
  std::string extension;            ///< --format, for outputs in a folder; empty: that of the input
  std::string frames;               ///< "1-24x2"; empty: all that exist
  LayerChoice depth, normal, motion;
};

/// Whether all frames go into this one output, a video or standard output.
bool is_one_output(const std::string& output);

/// A frame of a sequence, without an output. Errors: usage (a pattern for depth or normal that is none).
Result<FrameJob> job_of(const FrameListRequest& request, const std::string& sequence, const FrameFile& file);

/// Errors: usage (a plain output for several frames, two inputs for one output, an output that is an input), io
/// (nothing matches).
Result<std::vector<FrameJob>> list_frames(const FrameListRequest& request);

}  // namespace afterglow
