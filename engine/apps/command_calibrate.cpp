// SPDX-License-Identifier: MIT
// `afterglow calibrate`: measures how a device executes stacks fastest; `run` then looks it up and measures nothing.
#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "apps/command.h"
#include "apps/interrupt.h"
#include "apps/options.h"
#include "apps/output.h"
#include "bench/calibrate.h"
#include "core/paths.h"
#include "core/table.h"
#include "core/written_files.h"

namespace afterglow {
namespace {

struct CalibrateArguments {
  DeviceArguments device;
  std::string look, size = "1280x720", out;
  int repeat = 9;
};

void print(const bench::CalibrationResult& result) {
  output("{} with {}\n", result.device.name, result.device.driver);
  Table operations({"operation", "ns a pixel"});
  for (const auto& cost : result.operations)
    operations.add({cost.name, fmt::format("{:.2f}", cost.nanoseconds_per_pixel)});
  Table ways({"execution", "ms", "error p99.99"});
  for (const auto& p : result.cell.points)
    ways.add({p.choice, fmt::format("{:.2f}", p.execute.median),
              p.quality ? fmt::format("{:.1e}", p.quality->error.percentile) : "–"});
  for (const auto& p : result.reductions.points)
    ways.add({p.choice + ", reductions", fmt::format("{:.2f}", p.execute.median), "–"});
  Table chosen({"from --max-error", "chosen"});
  for (const auto& [max_error, choice] : result.choices)
    chosen.add({fmt::format("{:g}", max_error), execution_name(choice)});
  output("{}\n{}\n{}", operations.text("  "), ways.text("  "), chosen.text("  "));
}

Result<void> run_calibrate(const CalibrateArguments& a, Console& console) {
  keep_standard_output_for({a.out});
  const auto looks = find_installation() / "calibration";
  bench::CalibrationRequest request{
      .look = a.look, .reductions = looks / "reductions.lua", .base = {}, .size = {}, .repeat = a.repeat};
  if (a.look.empty()) {
    request.look = looks / "look.lua";
  } else {
    AFTERGLOW_TRY(request.look, named_preset(a.look, {}));
  }
  AFTERGLOW_TRY(request.size, parse_size(a.size));
  request.base.cache_folder = cache_folder();
  const SideFile table{"-o", a.out};
  AFTERGLOW_CHECK(check_written({&table, 1}, {}, {}));
  AFTERGLOW_TRY(const DeviceOptions asked, a.device.options());
  AFTERGLOW_TRY(const auto device, Device::create(asked, console.diagnostics()));
  const auto start = std::chrono::steady_clock::now();
  const auto step = [&](const std::string& what) -> Result<void> {
    if (interrupted()) return interrupt_error();
    console.progress(0, 1, what, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    return {};
  };
  AFTERGLOW_TRY(const auto result, bench::calibrate(*device, request, console.diagnostics(), step));
  console.end_progress();
  print(result);
  if (a.out.empty()) return {};
  return output_file(a.out, bench::calibration_json(result));
}

}  // namespace

Command add_calibrate_command(CLI::App& program) {
  auto* app = program.add_subcommand("calibrate", "Measure how this device executes stacks fastest");
  auto arguments = std::make_shared<CalibrateArguments>();
  app->add_option("-o,--output", arguments->out, "Table to write, for `run --calibration FILE`")->type_name("FILE");
  app->add_option("--look", arguments->look, "Look to measure on (default: one that comes with the program)")
      ->type_name("PRESET");
  app->add_option("--size", arguments->size, "Size of the picture (default 1280x720)")->type_name("WxH");
  app->add_option("--repeat", arguments->repeat, "Rounds; medians are of as many (default 9)")
      ->check(CLI::Range(1, 1000));
  arguments->device.add(*app);
  app->footer("Takes a minute or so; best on a quiet machine.");
  return {app, [arguments](Console& console) { return run_calibrate(*arguments, console); }};
}

}  // namespace afterglow
