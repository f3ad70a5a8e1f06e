// SPDX-License-Identifier: MIT
// `afterglow bench`: run time against error of every way of execution, as files and as a table.
#include <fmt/format.h>

#include <memory>

#include "apps/bench_arguments.h"
#include "apps/command.h"
#include "apps/interrupt.h"
#include "apps/output.h"
#include "apps/reload_bench.h"
#include "bench/goals.h"
#include "bench/report.h"
#include "core/file.h"
#include "core/stopwatch.h"
#include "core/version.h"

namespace afterglow {
namespace {

/// Shows the progress of `total` steps; counts them itself where nobody else does.
bench::Step steps(Console& console, std::size_t total, std::function<std::size_t()> done = {}) {
  if (!done) done = [count = std::size_t{0}]() mutable { return count++; };
  return [&console, total, done = std::move(done), start = Clock::now()](const std::string& what) -> Result<void> {
    if (interrupted()) return interrupt_error();
    console.progress(done(), total, what, milliseconds_since(start) / 1000);
    return {};
  };
}

/// --compare with what is in `old`. Errors: other, when something is slower than --threshold allows.
Result<void> compare(const BenchArguments& a, const std::string& old, const bench::Report& report) {
  AFTERGLOW_TRY(const auto all, bench::compare_reports(old, a.compare, report));
  if (all.empty())
    return Error{ErrorKind::usage, "nothing that was measured now is in it", a.compare, 0,
                 "the same presets, sizes, variants"};
  output("{}", bench::comparison_text(all, a.threshold));
  const auto slower = std::ranges::count_if(all, [&](const auto& c) { return c.ratio() > a.threshold; });
  if (slower == 0) return {};
  return Error{ErrorKind::other, fmt::format("{} of {} are more than {:g} times as slow as in {}", slower, all.size(),
                                             a.threshold, a.compare)};
}

/// Looks and goals. `report` says what they run on.
Result<void> measure_times(const BenchArguments& a, Device& device, bench::Report& report, Console& console) {
  std::string old;
  if (!a.compare.empty()) {
    AFTERGLOW_TRY(old, read_named_file(a.compare));
    AFTERGLOW_CHECK(bench::compare_reports(old, a.compare, report));  // that it is a report
  }
  std::vector<bench::Goal> goals;
  if (!a.goals.empty()) {
    AFTERGLOW_TRY(goals, bench::load_goals(a.goals));
  }
  AFTERGLOW_TRY(const bench::MatrixRequest request, a.matrix());
  AFTERGLOW_CHECK(bench::check_report_folder(a.folder));  // before minutes of measuring
  const auto step =
      steps(console, request.cells() + goals.size(), [&report] { return report.cells.size() + report.goals.size(); });
  AFTERGLOW_CHECK(bench::measure_matrix(device, request, report, console.diagnostics(), step));
  AFTERGLOW_CHECK(bench::measure_goals(device, request.base, goals, report, console.diagnostics(), step));
  console.end_progress();
  for (const auto& cell : report.cells) output("{}", bench::cell_text(cell));
  output("{}", bench::goals_text(report.goals));
  AFTERGLOW_CHECK(bench::write_report(report, a.folder));
  return a.compare.empty() ? Result<void>() : compare(a, old, report);
}

/// --reload: edits instead of frames.
Result<void> measure_edits(const BenchArguments& a, Device& device, Console& console) {
  AFTERGLOW_TRY(const auto sizes, a.reload_sizes());
  AFTERGLOW_TRY(const auto presets, a.files());
  ReloadBenchOptions options;
  AFTERGLOW_TRY(options.stack, a.stack());
  AFTERGLOW_CHECK(bench::check_report_folder(a.folder));
  if (a.quick) options.edits = 3;
  const auto step = steps(console, presets.size() * sizes.size() * static_cast<std::size_t>(2 * options.edits));
  for (const auto& preset : presets)
    for (const Size size : sizes) {
      options.preset = std::filesystem::absolute(preset);
      options.size = size;
      auto measured = measure_reloads(device, options, console.diagnostics(), step);
      console.end_progress();
      if (!measured) return std::move(measured).error();
      output("{}: {}", preset.filename().string(), reload_bench_text(*measured));
      AFTERGLOW_CHECK(write_reload_bench(*measured, preset, device.info().name, a.folder));
    }
  return {};
}

/// --temporal: shots and resolutions instead of times.
Result<void> measure_steadiness(const BenchArguments& a, bench::Report& report, Console& console) {
  AFTERGLOW_TRY(const bench::StabilityRequest request, a.shots());
  AFTERGLOW_CHECK(bench::check_report_folder(a.folder));
  auto measured =
      bench::measure_stability(request, report, console.diagnostics(), steps(console, bench::steps_of(request)));
  console.end_progress();
  if (!measured) return measured;
  output("{}", bench::stability_text(report));
  return bench::write_report(report, a.folder);
}

Result<void> run_bench(const BenchArguments& a, Console& console) {
  AFTERGLOW_CHECK(a.check());
  AFTERGLOW_TRY(const DeviceOptions asked, a.device.options());
  AFTERGLOW_TRY(auto device, Device::create(asked, console.diagnostics()));
  if (a.reload) return measure_edits(a, *device, console);
  const DeviceInfo& info = device->info();
  bench::Report report{.version = version(),
                       .device = info.name,
                       .driver = info.driver,
                       .kind = info.type,
                       .repeat = a.rounds(),
                       .cells = {},
                       .goals = {},
                       .temporal = {},
                       .resolutions = {}};
  if (!a.temporal) return measure_times(a, *device, report, console);
  device.reset();  // sessions open their own
  return measure_steadiness(a, report, console);
}

}  // namespace

Command add_bench_command(CLI::App& program) {
  auto* app = program.add_subcommand("bench", "Measure run time against error");
  auto arguments = std::make_shared<BenchArguments>();
  arguments->add(*app);
  app->footer(
      "Examples:\n"
      "  afterglow bench presets/neon_night.lua -o bench\n"
      "  afterglow bench look.lua --sizes 1280x720 --variants \"plain16f,fused fp32+storage-reads\" --compare "
      "old/bench.json\n"
      "  afterglow bench look.lua --vary bloom.max_iterations=4,8,16 --quick\n"
      "All that is measured at one size is prepared first and then run in turns; upload and read-back are not in it.");
  return {app, [arguments](Console& console) { return run_bench(*arguments, console); }};
}

}  // namespace afterglow
