// SPDX-License-Identifier: MIT
#include "apps/play_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "apps/options.h"
#include "batch/run_report.h"
#include "core/json_text.h"
#include "core/table.h"
#include "core/text.h"
#include "core/version.h"

namespace afterglow {
namespace {

using Json = nlohmann::ordered_json;

const char* kind_name(BuildTimes::Kind kind) {
  switch (kind) {
    case BuildTimes::Kind::values:
      return "values";
    case BuildTimes::Kind::structure:
      return "structure";
    case BuildTimes::Kind::frame:
      return "frame";
    case BuildTimes::Kind::none:
      break;
  }
  return "none";
}

Json json_of(const Percentiles& p) {
  return {{"median", p.median}, {"p95", p.p95}, {"p99", p.p99}, {"max", p.most}, {"count", p.count}};
}

Json json_of(const ReloadLatency& latency) {
  return {{"kind", kind_name(latency.build.kind)},
          {"notice", latency.build.notice},
          {"script", latency.build.script},
          {"shader", latency.build.shader},
          {"pipeline", latency.build.pipeline},
          {"warm_up", latency.build.warm_up},
          {"wait", latency.build.wait},
          {"execute", latency.execute},
          {"present", latency.present},
          {"total", latency.total()}};
}

double bytes_a_pixel(const ReadAhead::Stats& cache) {
  return cache.pixels > 0 ? static_cast<double>(cache.bytes) / static_cast<double>(cache.pixels) : 0;
}

std::string line_of(const Percentiles& p) {
  return fmt::format("median {:.1f}, p95 {:.1f}, p99 {:.1f}, longest {:.1f} ms", p.median, p.p95, p.p99, p.most);
}

}  // namespace

std::string play_report_text(const PlayReport& report, Player& player) {
  const PlayerStats stats = player.stats();
  const Transport& transport = player.transport();
  std::string out = fmt::format("{} on {}\n", report.preset, report.device);
  out +=
      fmt::format("frames: {} shown ({} needed no pass), {} dropped, {} unreadable; {} at {} fps × {}\n", stats.shown,
                  stats.kept, stats.dropped, stats.unreadable, report.mode, transport.fps(), transport.speed());
  out += fmt::format("between frames: {}\n", line_of(stats.interval));
  out += fmt::format("work a frame:   {}\n", line_of(stats.work));
  out += fmt::format(
      "cache: {} of {} in {} pictures, {:.3g} bytes a pixel, {:.1f} ms to read one; {} turns came before their "
      "picture\n",
      memory_text(stats.cache.bytes), memory_text(stats.cache.max_bytes), stats.cache.pictures,
      bytes_a_pixel(stats.cache), stats.cache.milliseconds, stats.late);
  if (stats.rebuilding > 0)
    out += fmt::format("passes of {} frames were being built while they were due: the frame before stayed\n",
                       stats.rebuilding);
  if (!stats.latencies.empty()) {
    const ReloadLatency& last = stats.latencies.back();
    out += fmt::format(
        "reloads: {}; the last ({}) took {:.1f} ms: notice {:.1f}, script {:.1f}, shader {:.1f}, pipeline {:.1f}, "
        "warm-up "
        "{:.1f}, wait "
        "{:.1f}, execute {:.1f}, present {:.1f}\n",
        stats.reloads, kind_name(last.build.kind), last.total(), last.build.notice, last.build.script,
        last.build.shader, last.build.pipeline, last.build.warm_up, last.build.wait, last.execute, last.present);
  }
  return out;
}

std::string play_report_json(const PlayReport& report, Player& player) {
  const PlayerStats stats = player.stats();
  const Transport& transport = player.transport();
  const Footage& footage = player.footage();
  Json out{
      {"afterglow", version()},
      {"preset", report.preset},
      {"device", report.device},
      {"driver", report.driver},
      {"footage", Json{{"frames", footage.frames()}, {"pictures", footage.pictures()}, {"missing", footage.missing()}}},
      {"playing", Json{{"mode", report.mode},
                       {"fps", transport.fps()},
                       {"speed", transport.speed()},
                       {"loop", loop_mode_name(transport.loop())}}}};
  if (footage.variable_rate()) {  // when each picture shows, in seconds
    Json times = Json::array();
    for (int position = 0, last = -1; position < footage.frames(); ++position)
      if (const FootageFrame& frame = footage.frame(position); frame.picture != std::exchange(last, frame.picture))
        times.push_back(frame.time.value_or(position / transport.fps()));
    out["footage"]["times"] = std::move(times);
  }
  out["frames"] = Json{{"shown", stats.shown},           {"dropped", stats.dropped}, {"late", stats.late},
                       {"unreadable", stats.unreadable}, {"kept", stats.kept},       {"rebuilding", stats.rebuilding},
                       {"last", player.shown().number}};
  if (!stats.unreadable_frames.empty()) out["frames"]["unreadable_frames"] = stats.unreadable_frames;
  out["milliseconds"] = Json{{"startup", report.startup},
                             {"wall", report.wall},
                             {"interval", json_of(stats.interval)},
                             {"work", json_of(stats.work)},
                             {"read", stats.cache.milliseconds}};
  out["cache"] = Json{{"bytes", stats.cache.bytes},
                      {"most_bytes", stats.cache.most_bytes},
                      {"max_bytes", stats.cache.max_bytes},
                      {"pictures", stats.cache.pictures},
                      {"bytes_per_pixel", bytes_a_pixel(stats.cache)},
                      {"read", stats.cache.read},
                      {"evicted", stats.cache.evicted}};
  out["reloads"] = Json::array();
  for (const ReloadLatency& latency : stats.latencies) out["reloads"].push_back(json_of(latency));
  if (const auto& found = player.shown().not_finite) {
    Json one{{"frame", found->frame}, {"picture", found->name}};
    one.update(non_finite_json({.input = {}, .passes = found->passes, .overflows = {}, .untraced = found->untraced}));
    out["non_finite"] = std::move(one);
  }
  const LiveStatus status = player.live().status();
  if (status.error) out["preset_error"] = status.error->text();
  if (report.error) out["error"] = report.error->text();
  out["memory"] = Json{{"peak", peak_memory()}};
  return json_text(out);
}

std::string play_failure_json(const std::string& preset, const Error& error) {
  return json_text(Json{{"afterglow", version()}, {"preset", preset}, {"error", error.text()}});
}

}  // namespace afterglow
