// SPDX-License-Identifier: MIT
#include "bench/calibrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/operations.h"
#include "bench/picture.h"

namespace afterglow::bench {
namespace {

/// Errors that people allow: full floats, tight, the default, generous (math.md §13).
constexpr double kErrors[] = {1e-5, 5e-4, 2e-3, 5e-3};
constexpr double kWorthwhile = 0.97;

}  // namespace

std::vector<ExecutionConfig> candidates() {
  std::vector<ExecutionConfig> out;
  for (const Storage storage : {Storage::fp32, Storage::fp16})
    for (const bool hardware_filter : {false, true})
      for (const bool storage_reads : {false, true})
        for (const bool dispatched : {false, true})
          for (const int rows : {1, 4, kMaxRows}) {
            if (hardware_filter && rows > 1) continue;  // a filtered fetch serves one row
            out.push_back({.storage = storage,
                           .hardware_filter = hardware_filter,
                           .storage_reads = storage_reads,
                           .dispatched = dispatched,
                           .rows = rows});
          }
  return out;
}

std::vector<CalibratedChoice> fastest_within_errors(const std::vector<Point>& points) {
  std::vector<CalibratedChoice> out;
  double best = 0;
  for (const double error : kErrors) {
    // The first choice serves those who allow no error: however little a look shows of them, half floats and filtered
    // fetches have one.
    const bool for_all = out.empty();
    const Point* fastest = nullptr;
    std::optional<ExecutionConfig> choice;
    for (const auto& point : points) {
      if (!point.quality || !(point.quality->error.percentile <= error)) continue;
      const auto config = parse_execution(point.choice);
      if (!config || (for_all && (config->storage != Storage::fp32 || config->hardware_filter))) continue;
      if (fastest && point.execute.median >= fastest->execute.median) continue;
      fastest = &point;
      choice = *config;
    }
    if (for_all && !fastest) return out;
    if (!fastest || (!for_all && fastest->execute.median > kWorthwhile * best)) continue;
    out.push_back({for_all ? 0 : error, *choice});
    best = fastest->execute.median;
  }
  return out;
}

bool compute_pays(const std::vector<Point>& points) {
  return points.size() == 2 && points[1].execute.median < kWorthwhile * points[0].execute.median;
}

Result<CalibrationResult> calibrate(Device& device, const CalibrationRequest& request, Diagnostics& diagnostics,
                                    const Step& step) {
  CalibrationResult out;
  out.device = device.info();
  const Picture picture = make_picture(request.size);
  AFTERGLOW_TRY(out.operations, measure_operations(device, request.base, picture, request.repeat, step));
  CellRequest cell{.preset = request.look,
                   .base = request.base,
                   .variants = {},
                   .picture = &picture,
                   .repeat = request.repeat,
                   .quality = true,
                   .visible = false,
                   .passes = false};
  for (const ExecutionConfig& choice : candidates()) cell.variants.push_back({execution_name(choice), choice, {}, {}});
  AFTERGLOW_TRY(out.cell, measure_cell(device, cell, diagnostics, step));
  out.choices = fastest_within_errors(out.cell.points);
  if (out.choices.empty()) return Error{ErrorKind::other, "no way of execution gives the right picture here"};
  cell.preset = request.reductions;
  cell.quality = false;
  cell.variants.clear();
  ExecutionConfig way = out.choices.front().choice;
  for (const bool compute : {false, true}) {
    way.compute = compute;
    cell.variants.push_back({execution_name(way), way, {}, {}});
  }
  AFTERGLOW_TRY(out.reductions, measure_cell(device, cell, diagnostics, step));
  for (auto& choice : out.choices) choice.choice.compute = compute_pays(out.reductions.points);
  return out;
}

std::string calibration_json(const CalibrationResult& result) {
  using Json = nlohmann::ordered_json;
  Json entry{{"device", result.device.name}, {"driver", result.device.driver}, {"choices", Json::array()}};
  for (const auto& [max_error, choice] : result.choices)
    entry["choices"].push_back(Json{{"max_error", max_error}, {"choice", execution_name(choice)}});
  Json& measured = entry["measured"];
  measured["look"] = result.cell.preset;
  measured["size"] = fmt::format("{}x{}", result.cell.size.width, result.cell.size.height);
  for (const auto& point : result.cell.points)
    measured["choices"].push_back(
        Json{{"choice", point.choice},
             {"milliseconds", point.execute.median},
             {"error", point.quality ? Json(point.quality->error.percentile) : Json(nullptr)}});
  for (const auto& point : result.reductions.points)
    measured["reductions"].push_back(Json{{"choice", point.choice}, {"milliseconds", point.execute.median}});
  for (const auto& cost : result.operations) measured["nanoseconds_per_pixel"][cost.name] = cost.nanoseconds_per_pixel;
  return Json{{"devices", Json::array({std::move(entry)})}}.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace afterglow::bench
