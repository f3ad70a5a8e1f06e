// SPDX-License-Identifier: MIT
// The options of `afterglow run`, declared and understood.
#pragma once

#include <optional>
#include <string>

#include "apps/options.h"
#include "batch/batch_run.h"

namespace afterglow {

struct RunArguments {
  PresetArguments preset;
  DeviceArguments device;
  ExecutionArguments execution;
  FrameListRequest files;
  LayerArguments layers;
  std::string output_space, size, region;
  std::string type = "auto", dither = "auto", compression, nan_policy = "zero";
  std::optional<int> png_level, jpeg_quality;
  std::string codec, bitrate, pixel_format, audio;
  std::optional<int> crf;
  bool keep_partial = false, keep_layers = false, resume = false, watch = false, fail_fast = false, sandbox = false;
  std::optional<double> fps;
  std::optional<int> pre_roll;
  std::string cuts;
  std::string stats, report, lock, locked;

  void add(CLI::App& command);
  /// Errors: usage (sizes, regions, options that exclude each other, no such preset).
  Result<BatchRequest> request() const;
};

}  // namespace afterglow
