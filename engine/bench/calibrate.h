// SPDX-License-Identifier: MIT
// Which ways of execution are fastest on a device, measured on a real stack, and what single operations cost there.
#pragma once

#include <string>
#include <vector>

#include "bench/cell.h"
#include "exec/calibration.h"

namespace afterglow::bench {

/// What one operation on a full-size picture costs.
struct OperationCost {
  std::string name;  ///< "copy RGBA16F", "filtered fetch"
  double nanoseconds_per_pixel = 0;
};

struct CalibrationResult {
  DeviceInfo device;
  Cell cell;        ///< every candidate on the calibration's look
  Cell reductions;  ///< the first of `choices` on the look of reductions, without and with compute shaders
  std::vector<OperationCost> operations;
  std::vector<CalibratedChoice> choices;  ///< for Calibration
};

struct CalibrationRequest {
  std::filesystem::path look, reductions;
  StackOptions base;
  Size size{1280, 720};
  int repeat = 9;
};

/// The ways of execution that calibration tries: all combinations that make sense, fused.
std::vector<ExecutionConfig> candidates();

/// From measured points (with quality), the fastest within each of a few allowed errors. What does not gain at least 3
/// % over a more exact choice is left out, so that noise does not cost exactness. The first is for every error. Empty
/// when no point has a quality.
std::vector<CalibratedChoice> fastest_within_errors(const std::vector<Point>& points);

/// Whether the second point, with compute shaders, is faster than the first by more than 3 %.
bool compute_pays(const std::vector<Point>& points);

/// Errors: those of `measure_cell`.
Result<CalibrationResult> calibrate(Device& device, const CalibrationRequest& request, Diagnostics& diagnostics,
                                    const Step& step);

/// A table with one entry, for `Calibration::load`, and with all that was measured beside it.
std::string calibration_json(const CalibrationResult& result);

}  // namespace afterglow::bench
