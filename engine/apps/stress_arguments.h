// SPDX-License-Identifier: MIT
// The options of `afterglow stress`, declared and understood.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/options.h"
#include "stress/stress_run.h"

namespace afterglow {

struct StressArguments {
  std::vector<std::string> presets, effects, devices;
  PresetArguments preset;  // --path alone
  DeviceArguments device;  // --validate alone
  std::uint64_t seed = 1, cases = 0;
  std::optional<std::uint64_t> trial;
  std::optional<std::string> duration, repeat;
  std::string report, folder = "stress";
  std::vector<std::string> digests_of;
  bool quick = false, list = false;

  void add(CLI::App& command);
  /// On one of the `devices`, or "auto". Errors: usage (--for, AFTERGLOW_FORCE).
  Result<stress::StressRequest> request(const std::string& device) const;
  /// Numbers of --digests-of. Errors: usage.
  Result<std::vector<std::uint64_t>> trials() const;
  /// The file of --report for one of the devices.
  std::string report_file(const std::string& device) const;
};

}  // namespace afterglow
