// SPDX-License-Identifier: MIT
// Reports as tables for a terminal.
#include <fmt/format.h>

#include "bench/report.h"
#include "core/table.h"

namespace afterglow::bench {
namespace {

std::string look_name(const std::string& preset, const std::string& settings) {
  return preset + (settings.empty() ? "" : " " + settings);
}

std::string percent(double share) { return fmt::format("{:.2f} %", 100 * share); }

}  // namespace

std::string cell_text(const Cell& cell) {
  Table table({"", "variant", "ms", "quartiles", "÷ first", "÷ copy", "p99.99", "max", "PSNR"});
  for (const auto& p : cell.points) {
    const auto& q = p.quality;
    table.add({p.front ? "*" : "", p.label + (p.settings.empty() ? "" : " " + p.settings),
               fmt::format("{:.2f}", p.execute.median), fmt::format("{:.2f}–{:.2f}", p.execute.lower, p.execute.upper),
               fmt::format("{:.2f}", cell.points.front().execute.median / p.execute.median),
               fmt::format("{:.2f}", p.execute.median / cell.copy.median),
               q ? fmt::format("{:.1e}", q->error.percentile) : "–", q ? fmt::format("{:.1e}", q->error.worst) : "–",
               q ? fmt::format("{:.0f}", q->psnr) : "–"});
  }
  return fmt::format("\n{} {}×{}; errors against {}\n{}  one copy pass {:.2f} ms; memory copy {:.2f} ms, {:.1f} GB/s\n",
                     cell.preset, cell.size.width, cell.size.height, cell.truth, table.text("  "), cell.copy.median,
                     cell.memory.median, cell.gigabytes_per_second);
}

std::string goals_text(const std::vector<GoalResult>& goals) {
  if (goals.empty()) return {};
  Table table({"goal", "size", "measured", "wanted", "reached"});
  for (const auto& g : goals)
    table.add({g.name, g.size,
               g.ratio ? fmt::format("{:.2f}{}{}", *g.ratio, g.unit.empty() ? "" : " ", g.unit) : g.note,
               fmt::format("{} {:g}", g.at_least ? "≥" : "≤", g.goal),
               !g.ratio      ? "–"
               : g.reached() ? "yes"
                             : "no"});
  return "\n" + table.text();
}

std::string stability_text(const Report& report) {
  Table shots({"look", "shot", "swing", "flicker", "of pixels"});
  for (const auto& c : report.temporal)
    shots.add({look_name(c.preset, c.settings), c.scene, percent(c.swing), percent(c.flicker), percent(c.pixels)});
  Table sizes({"look", "size", "largest difference", "RMS"});
  for (const auto& p : report.resolutions)
    sizes.add({look_name(p.preset, p.settings), fmt::format("{}×{}", p.size.width, p.size.height), percent(p.worst),
               percent(p.rms)});
  return "light that is added, over the frames\n" + shots.text("  ") +
         "\nlight that is added, against the first size\n" + sizes.text("  ");
}

std::string comparison_text(const std::vector<Comparison>& comparisons, double threshold) {
  Table table({"", "before ms", "now ms", "now ÷ before"});
  for (const auto& c : comparisons)
    table.add({c.what, fmt::format("{:.2f}", c.before), fmt::format("{:.2f}", c.now),
               fmt::format("{:.2f}{}", c.ratio(), c.ratio() > threshold ? "  slower" : "")});
  return "\n" + table.text();
}

}  // namespace afterglow::bench
