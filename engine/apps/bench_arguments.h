// SPDX-License-Identifier: MIT
// The options of `afterglow bench`, declared and understood.
#pragma once

#include <string>
#include <vector>

#include "apps/options.h"
#include "bench/matrix.h"
#include "bench/shots.h"

namespace afterglow {

struct BenchArguments {
  std::vector<std::string> presets, vary;
  PresetArguments preset;  // --set and --path alone
  DeviceArguments device;
  ExecutionArguments execution;  // --max-error and --calibration alone
  std::string sizes, variants, picture, folder = "bench", goals, compare;
  int repeat = 9, scaling = 0;
  double threshold = 1.15;
  bool quick = false, reload = false, temporal = false;

  void add(CLI::App& command);
  /// Errors: usage (nothing to measure).
  Result<void> check() const;

  int rounds() const;  ///< of everything that is measured
  /// How stacks are made. Errors: usage.
  Result<StackOptions> stack() const;
  // What is measured, with the sizes and ways that are left out. Errors: usage, script (no such preset).
  Result<bench::MatrixRequest> matrix() const;
  Result<bench::StabilityRequest> shots() const;
  Result<std::vector<std::filesystem::path>> files() const;  ///< of the presets
  Result<std::vector<Size>> reload_sizes() const;
};

}  // namespace afterglow
