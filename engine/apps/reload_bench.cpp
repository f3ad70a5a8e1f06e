// SPDX-License-Identifier: MIT
#include "apps/reload_bench.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "bench/picture.h"
#include "core/file.h"
#include "core/json_text.h"
#include "core/stopwatch.h"
#include "core/table.h"
#include "core/version.h"
#include "image/writer.h"
#include "play/player.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::chrono::seconds kLongest{60};  // an edit that takes longer was not noticed
constexpr double kForever = std::numeric_limits<double>::infinity();

/// The files that are edited, in a folder that goes with it.
class Workplace {
 public:
  Workplace() = default;
  ~Workplace() {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
  }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  fs::path path(const std::string& name) const { return folder_ / name; }

  Result<void> make(const ReloadBenchOptions& options, Diagnostics& diagnostics) {
    std::error_code problem;
    std::string name = (fs::temp_directory_path() / "afterglow-reload-XXXXXX").string();
    if (!mkdtemp(name.data()))
      return Error{ErrorKind::io, fmt::format("cannot be made: {}", std::strerror(errno)), name};
    folder_ = name;
    for (const char* folder : {"effects", "shaders/edited", "cache"}) fs::create_directories(folder_ / folder, problem);
    if (problem) return Error{ErrorKind::io, "cannot be made: " + problem.message(), folder_.string()};
    fs::copy_file(options.preset, path("measured.lua"), fs::copy_options::overwrite_existing, problem);
    if (problem) return Error{ErrorKind::io, "cannot be read: " + problem.message(), options.preset.string()};
    AFTERGLOW_CHECK(write_file_atomically(path("effects/edited.lua"), R"(local fx = require "afterglow"
return fx.effect {
  name = "edited", doc = "What is edited.", at = "after_post_process", order = 1000,
  settings = { gain = fx.float { min = 0, default = 1, doc = "Factor." } },
  build = function(g, s, source) return g:pass { shader = "edited/edited", source = source, gain = s.gain } end,
}
)"));
    AFTERGLOW_CHECK(edit_value(0));
    AFTERGLOW_CHECK(edit_shader(0));
    Picture picture = bench::make_picture(options.size);
    AFTERGLOW_CHECK(write_picture(picture, path("picture.1.exr"), {}, diagnostics));
    for (float& value : picture.color.pixels) value *= 0.5f;  // another picture, for whole frames
    return write_picture(picture, path("picture.2.exr"), {}, diagnostics);
  }
  Result<void> edit_value(int number) const {
    return write_file_atomically(path("look.lua"),
                                 fmt::format("local fx = require \"afterglow\"\nreturn fx.extend(\"measured\", {{\n  "
                                             "fx.edited {{ gain = {} }},\n}})\n",
                                             1 + 1e-3 * number));
  }
  /// Code that no cache can have: neither ours nor the driver's.
  Result<void> edit_shader(int number) const {
    return write_file_atomically(
        path("shaders/edited/edited.glsl"),
        fmt::format("uniform float gain;\n\nvec4 apply(vec4 color) {{\n  return vec4(color.rgb * "
                    "gain + {:.9f} * color.a, color.a);\n}}\n",
                    1e-9 * (seed_ + number)));
  }

 private:
  fs::path folder_;
  double seed_ = static_cast<double>(std::random_device{}() % 10'000'000);
};

/// One edit, from just before it is written until its picture is there.
Result<double> time_edit(Player& player, const std::function<Result<void>()>& edit) {
  const auto reloads = player.stats().reloads;
  const auto start = Clock::now();
  AFTERGLOW_CHECK(edit());
  while (player.stats().reloads == reloads) {
    if (auto step = player.step(); !step) return std::move(step).error();
    if (player.stats().reloads != reloads) break;
    if (const auto status = player.live().status(); status.error && !status.building) return *status.error;
    if (Clock::now() - start > kLongest) return Error{ErrorKind::io, "an edit was not noticed within a minute"};
    player.wait(kForever);
  }
  return milliseconds_since(start);
}

/// All passes of a frame: of two pictures in turns.
Result<double> frame_time(Player& player) {
  std::vector<double> work;
  for (int i = 0; i < 9; ++i) {
    player.transport().step(1, player.now());
    player.settle();
    const auto start = Clock::now();
    if (auto step = player.step(); !step) return std::move(step).error();
    work.push_back(milliseconds_since(start));
  }
  return Percentiles::of(work).median;
}

template <class Value>
double median(const std::vector<ReloadLatency>& all, Value value) {
  std::vector<double> values;
  for (const auto& latency : all) values.push_back(value(latency));
  return Percentiles::of(values).median;
}

std::string json_of(const ReloadBench& bench, const std::string& device) {
  Json out{{"afterglow", version()},
           {"device", device},
           {"width", bench.size.width},
           {"height", bench.size.height},
           {"frame_milliseconds", bench.frame}};
  for (const ReloadRow& row : bench.rows) {
    const Percentiles seen = Percentiles::of(row.seen);
    const auto of = [&](auto value) { return median(row.latencies, value); };
    out["edits"].push_back(Json{{"kind", row.kind},
                                {"count", seen.count},
                                {"median", seen.median},
                                {"p95", seen.p95},
                                {"max", seen.most},
                                {"medians", Json{{"notice", of([](const auto& l) { return l.build.notice; })},
                                                 {"script", of([](const auto& l) { return l.build.script; })},
                                                 {"shader", of([](const auto& l) { return l.build.shader; })},
                                                 {"pipeline", of([](const auto& l) { return l.build.pipeline; })},
                                                 {"warm_up", of([](const auto& l) { return l.build.warm_up; })},
                                                 {"wait", of([](const auto& l) { return l.build.wait; })},
                                                 {"execute", of([](const auto& l) { return l.execute; })}}},
                                {"samples", row.seen}});
  }
  return json_text(out);
}

}  // namespace

Result<ReloadBench> measure_reloads(Device& device, const ReloadBenchOptions& options, Diagnostics& diagnostics,
                                    const std::function<Result<void>(const std::string& what)>& step) {
  Workplace place;
  AFTERGLOW_CHECK(place.make(options, diagnostics));
  PlayerOptions playing;
  playing.preset = place.path("look.lua");
  playing.live.stack = options.stack;
  playing.live.stack.cache_folder = place.path("cache");
  // What the preset finds beside itself.
  playing.live.stack.preset.paths.insert(playing.live.stack.preset.paths.begin(), options.preset.parent_path());
  playing.footage.inputs = {place.path("picture.#.exr").string()};
  AFTERGLOW_TRY(const auto player, Player::open(device, playing, diagnostics));
  player->settle();
  if (auto first = player->step(); !first) return std::move(first).error();
  if (const auto status = player->live().status(); status.error) return *status.error;

  ReloadBench bench;
  bench.size = options.size;
  for (const bool shader : {false, true}) {
    ReloadRow row{.kind = shader ? "shader" : "value", .seen = {}, .latencies = {}};
    for (int i = 1; i <= options.edits; ++i) {
      AFTERGLOW_CHECK(step(fmt::format("{} edit", row.kind)));
      AFTERGLOW_TRY(const double seen, time_edit(*player, [&]() -> Result<void> {
                      return shader ? place.edit_shader(i) : place.edit_value(i);
                    }));
      row.seen.push_back(seen);
      row.latencies.push_back(player->stats().latencies.back());
    }
    bench.rows.push_back(std::move(row));
  }
  AFTERGLOW_TRY(bench.frame, frame_time(*player));
  return bench;
}

std::string reload_bench_text(const ReloadBench& bench) {
  Table table(
      {"edit", "count", "median ms", "p95", "notice", "script", "shader", "pipeline", "warm-up", "wait", "execute"});
  for (const ReloadRow& row : bench.rows) {
    const Percentiles seen = Percentiles::of(row.seen);
    const auto of = [&](auto value) { return fmt::format("{:.1f}", median(row.latencies, value)); };
    table.add({row.kind, std::to_string(seen.count), fmt::format("{:.1f}", seen.median),
               fmt::format("{:.1f}", seen.p95), of([](const auto& l) { return l.build.notice; }),
               of([](const auto& l) { return l.build.script; }), of([](const auto& l) { return l.build.shader; }),
               of([](const auto& l) { return l.build.pipeline; }), of([](const auto& l) { return l.build.warm_up; }),
               of([](const auto& l) { return l.build.wait; }), of([](const auto& l) { return l.execute; })});
  }
  return fmt::format("from the save to the new picture at {}×{}; a whole frame takes {:.1f} ms\n{}", bench.size.width,
                     bench.size.height, bench.frame, table.text("  "));
}

Result<void> write_reload_bench(const ReloadBench& bench, const std::filesystem::path& preset,
                                const std::string& device, const std::filesystem::path& folder) {
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  const auto [width, height] = bench.size;
  return write_file_atomically(folder / fmt::format("reload-{}-{}x{}.json", preset.stem().string(), width, height),
                               json_of(bench, device));
}

}  // namespace afterglow
