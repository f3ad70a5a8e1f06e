// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "bench/report.h"

namespace afterglow::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kWhatItIs = "afterglow bench 1";

Json spread_json(const Spread& spread) {
  return {{"median", spread.median},
          {"lower_quartile", spread.lower},
          {"upper_quartile", spread.upper},
          {"samples", spread.samples}};
}

/// JSON has no infinity.
Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json quality_json(const Quality& quality) {
  Json out{{"max", finite(quality.error.worst)},
           {"p9999", finite(quality.error.percentile)},
           {"rms", finite(quality.error.rms)},
           {"psnr", finite(quality.psnr)}};
  out["visible"] = quality.visible ? Json(*quality.visible) : Json(nullptr);
  return out;
}

Json point_json(const Point& point) {
  Json out{{"choice", point.choice},
           {"label", point.label},
           {"settings", point.settings},
           {"kernels", point.kernels},
           {"image_memory", point.image_memory},
           {"traffic_bytes", point.traffic},
           {"unavoidable_bytes", point.unavoidable},
           {"execute", spread_json(point.execute)},
           {"upload", point.upload},
           {"read_back", point.read_back},
           {"error", point.quality ? quality_json(*point.quality) : Json(nullptr)},
           {"front", point.front},
           {"passes", Json::array()}};
  for (const auto& pass : point.passes)
    out["passes"].push_back(Json{{"name", pass.name}, {"milliseconds", pass.milliseconds}});
  return out;
}

Json cell_json(const Cell& cell) {
  Json out{{"preset", cell.preset},
           {"width", cell.size.width},
           {"height", cell.size.height},
           {"truth", cell.truth},
           {"copy", spread_json(cell.copy)},
           {"memory", spread_json(cell.memory)},
           {"gigabytes_per_second", cell.gigabytes_per_second},
           {"points", Json::array()}};
  for (const auto& point : cell.points) out["points"].push_back(point_json(point));
  return out;
}

Json goal_json(const GoalResult& goal) {
  Json out{{"name", goal.name},
           {"size", goal.size},
           {"measured", goal.ratio ? Json(*goal.ratio) : Json(nullptr)},
           {"goal", goal.goal},
           {"next", goal.next ? Json(*goal.next) : Json(nullptr)},
           {"at_least", goal.at_least},
           {"unit", goal.unit},
           {"reached", goal.reached()},
           {"note", goal.note}};
  return out;
}

Json temporal_json(const TemporalCurve& curve) {
  return {{"preset", curve.preset},    {"settings", curve.settings},  {"scene", curve.scene},
          {"width", curve.size.width}, {"height", curve.size.height}, {"radius", curve.radius},
          {"light", curve.light},      {"swing", curve.swing},        {"flicker", curve.flicker},
          {"pixels", curve.pixels}};
}

Json resolution_json(const ResolutionPoint& point) {
  return {{"preset", point.preset},      {"settings", point.settings}, {"width", point.size.width},
          {"height", point.size.height}, {"worst", point.worst},       {"rms", point.rms}};
}

std::string key(const std::string& preset, int width, int height, const std::string& label, const std::string& choice,
                const std::string& settings) {
  const std::string name = label.empty() || label == choice ? choice : label;
  return fmt::format("{} {}×{} {}{}{}", preset, width, height, name, settings.empty() ? "" : " ", settings);
}

}  // namespace

std::string report_json(const Report& report) {
  Json out{{"format", kWhatItIs}, {"afterglow", report.version}, {"device", report.device}, {"driver", report.driver},
           {"kind", report.kind}, {"repeat", report.repeat},     {"cells", Json::array()},  {"goals", Json::array()}};
  for (const auto& cell : report.cells) out["cells"].push_back(cell_json(cell));
  for (const auto& goal : report.goals) out["goals"].push_back(goal_json(goal));
  out["temporal"] = out["resolutions"] = Json::array();
  for (const auto& curve : report.temporal) out["temporal"].push_back(temporal_json(curve));
  for (const auto& point : report.resolutions) out["resolutions"].push_back(resolution_json(point));
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<std::vector<Comparison>> compare_reports(const std::string& old_json, const std::string& file,
                                                const Report& now) {
  const Error wrong{ErrorKind::io, "is no report of `afterglow bench`", file};
  const auto old = nlohmann::json::parse(old_json, nullptr, false);
  if (!old.is_object() || old.value("format", nlohmann::json()) != kWhatItIs) return wrong;
  std::map<std::string, double> before;
  try {
    for (const auto& cell : old.at("cells"))
      for (const auto& point : cell.at("points"))
        before[key(cell.at("preset"), cell.at("width"), cell.at("height"), point.at("label"), point.at("choice"),
                   point.at("settings"))] = point.at("execute").at("median");
  } catch (const nlohmann::json::exception&) {
    return wrong;
  }
  std::vector<Comparison> out;
  for (const auto& cell : now.cells)
    for (const auto& point : cell.points) {
      const auto name = key(cell.preset, cell.size.width, cell.size.height, point.label, point.choice, point.settings);
      if (const auto found = before.find(name); found != before.end() && found->second > 0)
        out.push_back({name, found->second, point.execute.median});
    }
  return out;
}

}  // namespace afterglow::bench
