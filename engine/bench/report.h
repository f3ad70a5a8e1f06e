// SPDX-License-Identifier: MIT
// A report as files and as tables for a terminal.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/results.h"
#include "core/result.h"

namespace afterglow::bench {

/// Everything, with every sample; see docs/benchmarks/README.md for its parts.
std::string report_json(const Report& report);
/// One line a point.
std::string report_csv(const Report& report);
/// One line a shot, then one line a size, of `temporal` and `resolutions`.
std::string stability_csv(const Report& report);
/// Swing against the highlight's radius, one line for each setting of each preset.
std::string temporal_svg(const Report& report);
/// One page that needs no other file and no network: run time against error, cost per pass, scaling, goals.
std::string report_html(const Report& report);
/// Run time against error of one cell, with the front drawn.
std::string front_svg(const Report& report, const Cell& cell);

/// Whether a report can be written there, before anything is measured. Makes nothing. Errors: io.
Result<void> check_report_folder(const std::filesystem::path& folder);
/// bench.json, bench.csv, bench.html, front.svg (of the cell with most points) and, of what is steady, stability.csv
/// and temporal.svg in `folder`, which is made. Errors: io.
Result<void> write_report(const Report& report, const std::filesystem::path& folder);

/// One point of two reports, medians in milliseconds.
struct Comparison {
  std::string what;  ///< "neon_night 1920×1080 fused fp32"
  double before = 0, now = 0;
  double ratio() const { return now / before; }
};
/// Points that are in both. Errors: io (`old_json` is no report).
Result<std::vector<Comparison>> compare_reports(const std::string& old_json, const std::string& file,
                                                const Report& now);

std::string cell_text(const Cell& cell);
std::string goals_text(const std::vector<GoalResult>& goals);  ///< empty when there are none
std::string stability_text(const Report& report);
/// Ratios beyond `threshold` are marked.
std::string comparison_text(const std::vector<Comparison>& comparisons, double threshold);

}  // namespace afterglow::bench
