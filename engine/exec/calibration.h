// SPDX-License-Identifier: MIT
// What `afterglow calibrate` has measured: which choice is fastest on a device within an allowed error. Running a
// preset measures nothing; it looks the choice up here, so that two machines with the same device and table make the
// same pixels.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "gpu/device.h"
#include "shader/execution_config.h"

namespace afterglow {

/// Fastest where at least this error is allowed.
struct CalibratedChoice {
  double max_error = 0;  ///< E of math.md §13
  ExecutionConfig choice;
};

/// What is known of some devices. A pattern that ends in '*' fits what begins so; an empty one fits everything.
struct CalibrationEntry {
  std::string device, driver;  ///< patterns for the names that `afterglow devices` lists
  std::string kind;            ///< "cpu", "gpu", or empty: both
  std::vector<CalibratedChoice> choices;

  bool fits(const DeviceInfo& info) const;
  std::string name() const;  ///< "llvmpipe*", "any gpu"
};

/// A table of entries; the first that fits counts. Immutable and thread-safe after loading.
struct Calibration {
  std::string file;  ///< where it came from; empty for an empty table
  std::vector<CalibrationEntry> entries;

  /// Errors (io): not JSON, not such a table, an unknown choice; they name the entry.
  static Result<Calibration> parse(const std::string& json, const std::string& file);
  static Result<Calibration> load(const std::filesystem::path& file);
  /// The table that comes with the program, in `installation` or else in find_installation(); empty where there is
  /// none.
  static Result<Calibration> shipped(const std::filesystem::path& installation = {});

  struct Found {
    ExecutionConfig choice;
    std::string from;  ///< for reports: "calibration/devices.json, llvmpipe*"
  };
  /// The choice with the largest `max_error` that is allowed, from the first entry that has one; without any,
  /// ExecutionConfig{}, which is exact on every device.
  Found find(const DeviceInfo& info, double max_error) const;
};

/// Reads the words of AFTERGLOW_FORCE, separated by commas, spaces or '+': "staging", "unmapped", "timestamps", and
/// those of an ExecutionConfig ("fp16", "hardware-filter", "compute", "rows1", …). Errors: usage.
Result<ForcedWays> parse_forced(const std::string& text);

}  // namespace afterglow
