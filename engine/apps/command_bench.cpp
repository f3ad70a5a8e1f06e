// SPDX-License-Identifier: MIT
// `afterglow bench`: run time against error of every way of execution, as files and as a table.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "apps/bench_matrix.h"
#include "apps/bench_stability.h"
#include "apps/command.h"
#include "apps/interrupt.h"
#include "apps/options.h"
#include "apps/output.h"
#include "apps/reload_bench.h"
#include "batch/scale.h"
#include "bench/cell.h"
#include "bench/goals.h"
#include "bench/picture.h"
#include "bench/report.h"
#include "core/file.h"
#include "core/paths.h"
#include "core/table.h"
#include "core/version.h"
#include "image/reader.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

struct BenchArguments {
  std::vector<std::string> presets, vary;
  PresetArguments preset;  // --set and --path alone
  DeviceArguments device;
  ExecutionArguments execution;  // --max-error and --calibration alone
  std::string sizes, variants, picture, out = "bench", goals, compare;
  int repeat = 9, scaling = 0;
  double threshold = 1.15;
  bool quick = false, reload = false, temporal = false;
};

/// --quick: enough to see that everything works.
constexpr const char* kQuickSizes = "320x180";
constexpr const char* kSizes = "1920x1080,3840x2160";
constexpr const char* kReloadSizes = "1280x720";
constexpr const char* kResolutions = "960x540,1280x720,1920x1080,3840x2160";
constexpr const char* kQuickResolutions = "160x90,320x180";
constexpr const char* kQuickVariants = "plain16f,chosen";
constexpr int kQuickRepeat = 3;

struct Bench {
  const BenchArguments& arguments;
  Console& console;
  std::unique_ptr<Device> device;
  StackOptions base;
  bench::Report report;
  std::size_t total = 1;  ///< cells and goals to measure
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();

  bench::Step step() {
    return [this](const std::string& what) -> Result<void> {
      if (interrupted()) return interrupt_error();
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      console.progress(report.cells.size() + report.goals.size(), total, what, seconds.count());
      return {};
    };
  }
};

Result<Picture> picture_of(const Bench& bench, Size size) {
  if (bench.arguments.picture.empty()) return bench::make_picture(size);
  ReadOptions options;
  options.auxiliary = {"depth", "normal"};
  AFTERGLOW_TRY(Picture picture, read_picture(bench.arguments.picture, options, bench.console.diagnostics()));
  scale_picture(picture, {size});
  return picture;
}

Result<void> measure(Bench& bench, Size size, const std::vector<bench::Variant>& variants, bool details) {
  AFTERGLOW_TRY(const Picture picture, picture_of(bench, size));
  for (const auto& preset : bench.arguments.presets) {
    const bench::CellRequest request{.preset = preset,
                                     .base = bench.base,
                                     .variants = variants,
                                     .picture = &picture,
                                     .repeat = bench.report.repeat,
                                     .quality = details,
                                     .passes = details};
    AFTERGLOW_TRY(bench::Cell cell,
                  bench::measure_cell(*bench.device, request, bench.console.diagnostics(), bench.step()));
    bench.report.cells.push_back(std::move(cell));
  }
  return {};
}

Result<void> measure_matrix(Bench& bench) {
  const BenchArguments& a = bench.arguments;
  const std::string sizes = !a.sizes.empty() ? a.sizes : a.quick ? kQuickSizes : kSizes;
  const std::string names = !a.variants.empty() ? a.variants : a.quick ? kQuickVariants : kDefaultVariants;
  AFTERGLOW_TRY(const auto all_sizes, parse_sizes(sizes));
  AFTERGLOW_TRY(const auto variants, parse_variants(names));
  AFTERGLOW_TRY(const auto varied, vary_settings(variants, a.vary));
  bench.total = a.presets.size() * (all_sizes.size() + scaling_sizes(a.scaling).size());
  for (const Size size : all_sizes) AFTERGLOW_CHECK(measure(bench, size, varied, true));
  AFTERGLOW_TRY(const auto chosen, parse_variants("chosen"));
  for (const Size size : scaling_sizes(a.scaling)) AFTERGLOW_CHECK(measure(bench, size, chosen, false));
  return {};
}

Result<void> measure_goals(Bench& bench) {
  AFTERGLOW_TRY(const auto goals, bench::load_goals(bench.arguments.goals));
  bench.total = bench.report.cells.size() + goals.size();
  std::error_code problem;
  const fs::path folder = fs::temp_directory_path(problem) / fmt::format("afterglow-bench-{}", getpid());
  for (const auto& goal : goals) {
    fs::create_directories(folder, problem);
    auto result =
        bench::measure_goal(*bench.device, bench.base, goal, {fs::read_symlink("/proc/self/exe", problem), folder},
                            bench.console.diagnostics(), bench.step());
    fs::remove_all(folder, problem);
    if (!result) return std::move(result).error();
    bench.report.goals.push_back(std::move(result).value());
  }
  return {};
}

void print_cell(const bench::Cell& cell) {
  output("\n{} {}×{}; errors against {}\n", cell.preset, cell.size.width, cell.size.height, cell.truth);
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
  output("{}  one copy pass {:.2f} ms; memory copy {:.2f} ms, {:.1f} GB/s\n", table.text("  "), cell.copy.median,
         cell.memory.median, cell.gigabytes_per_second);
}

void print_goals(const std::vector<bench::GoalResult>& goals) {
  if (goals.empty()) return;
  Table table({"goal", "size", "measured", "wanted", "reached"});
  for (const auto& g : goals)
    table.add({g.name, g.size,
               g.ratio ? fmt::format("{:.2f}{}{}", *g.ratio, g.unit.empty() ? "" : " ", g.unit) : g.note,
               fmt::format("{} {:g}", g.at_least ? "≥" : "≤", g.goal),
               !g.ratio      ? "–"
               : g.reached() ? "yes"
                             : "no"});
  output("\n{}", table.text());
}

/// Ratios to an older report. Errors: other, when one is beyond the threshold.
Result<void> compare(const Bench& bench) {
  const BenchArguments& a = bench.arguments;
  AFTERGLOW_TRY(const std::string old, read_file(a.compare));
  AFTERGLOW_TRY(const auto comparisons, bench::compare_reports(old, a.compare, bench.report));
  if (comparisons.empty())
    return Error{ErrorKind::usage, "nothing that was measured now is in it", a.compare, 0,
                 "the same presets, sizes, variants"};
  Table table({"", "before ms", "now ms", "now ÷ before"});
  std::size_t slower = 0;
  for (const auto& c : comparisons) {
    const bool beyond = c.ratio() > a.threshold;
    slower += beyond;
    table.add({c.what, fmt::format("{:.2f}", c.before), fmt::format("{:.2f}", c.now),
               fmt::format("{:.2f}{}", c.ratio(), beyond ? "  slower" : "")});
  }
  output("\n{}", table.text());
  if (slower == 0) return {};
  return Error{ErrorKind::other, fmt::format("{} of {} are more than {:g} times as slow as in {}", slower,
                                             comparisons.size(), a.threshold, a.compare)};
}

/// --reload: edits instead of frames.
Result<void> measure_all_reloads(Bench& bench) {
  constexpr int kEdits = 50, kQuickEdits = 3;
  const BenchArguments& a = bench.arguments;
  AFTERGLOW_TRY(const auto sizes, parse_sizes(!a.sizes.empty() ? a.sizes : a.quick ? kQuickSizes : kReloadSizes));
  const int edits = a.quick ? kQuickEdits : kEdits;
  bench.total = a.presets.size() * sizes.size() * static_cast<std::size_t>(2 * edits);
  for (const auto& name : a.presets) {
    AFTERGLOW_TRY(const fs::path preset, find_preset_file(name, {a.preset.paths.begin(), a.preset.paths.end()}));
    for (const Size size : sizes) {
      std::size_t done = 0;
      const ReloadBenchOptions options{
          .preset = fs::absolute(preset), .stack = bench.base, .size = size, .edits = edits};
      auto measured = measure_reloads(
          *bench.device, options, bench.console.diagnostics(), [&](const std::string& what) -> Result<void> {
            if (interrupted()) return interrupt_error();
            const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - bench.start;
            bench.console.progress(done++, bench.total, what, seconds.count());
            return {};
          });
      bench.console.end_progress();
      if (!measured) return std::move(measured).error();
      output("{}: {}", preset.filename().string(), reload_bench_text(*measured));
      std::error_code problem;
      fs::create_directories(a.out, problem);
      AFTERGLOW_CHECK(write_file_atomically(
          fs::path(a.out) / fmt::format("reload-{}-{}x{}.json", preset.stem().string(), size.width, size.height),
          reload_bench_json(*measured, bench.device->info().name)));
    }
  }
  return {};
}

/// --temporal: shots and resolutions instead of times.
Result<void> measure_steadiness(Bench& bench) {
  const BenchArguments& a = bench.arguments;
  StabilityRequest request{
      .presets = {}, .options = {}, .variants = {}, .sizes = {}, .shot = a.picture, .quick = a.quick};
  for (const auto& name : a.presets) {
    AFTERGLOW_TRY(const fs::path preset, find_preset_file(name, {a.preset.paths.begin(), a.preset.paths.end()}));
    request.presets.push_back(preset);
  }
  AFTERGLOW_TRY(request.options.device, a.device.options());
  request.options.stack = bench.base;
  AFTERGLOW_TRY(const auto chosen, parse_variants("chosen"));
  AFTERGLOW_TRY(request.variants, vary_settings(chosen, a.vary));
  AFTERGLOW_TRY(request.sizes, parse_sizes(!a.sizes.empty() ? a.sizes : a.quick ? kQuickResolutions : kResolutions));
  bench.device.reset();  // sessions open their own
  std::size_t done = 0;
  auto measured = measure_stability(
      request, bench.report, bench.console.diagnostics(), [&](const std::string& what) -> Result<void> {
        if (interrupted()) return interrupt_error();
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - bench.start;
        bench.console.progress(done++, steps_of(request), what, seconds.count());
        return {};
      });
  bench.console.end_progress();
  if (!measured) return measured;
  AFTERGLOW_CHECK(bench::write_report(bench.report, a.out));
  output("{}", stability_text(bench.report));
  return {};
}

Result<void> run_bench(const BenchArguments& a, Console& console) {
  if (a.temporal && a.presets.empty())
    return Error{ErrorKind::usage, "--temporal needs a look to measure", "afterglow bench", 0, "one or more PRESETs"};
  if (a.reload && a.presets.empty())
    return Error{ErrorKind::usage, "--reload needs a look to edit", "afterglow bench", 0, "one or more PRESETs"};
  if (a.presets.empty() && a.goals.empty())
    return Error{ErrorKind::usage, "nothing to measure", "afterglow bench", 0, "one or more PRESETs, --goals FILE"};
  Bench bench{.arguments = a, .console = console, .device = nullptr, .base = {}, .report = {}};
  AFTERGLOW_TRY(bench.base.preset, a.preset.options());
  bench.base.max_error = a.execution.max_error;
  bench.base.calibration = a.execution.calibration;
  bench.base.cache_folder = cache_folder();
  bench.base.max_memory = 64ull << 30;  // what does not fit is the device's to say
  AFTERGLOW_TRY(const DeviceOptions device, a.device.options());
  AFTERGLOW_TRY(bench.device, Device::create(device, console.diagnostics()));
  const DeviceInfo& info = bench.device->info();
  bench.report = {.version = version(),
                  .device = info.name,
                  .driver = info.driver,
                  .kind = info.type,
                  .repeat = a.quick ? kQuickRepeat : a.repeat,
                  .cells = {},
                  .goals = {}};

  if (a.reload) return measure_all_reloads(bench);
  if (a.temporal) return measure_steadiness(bench);
  if (!a.presets.empty()) AFTERGLOW_CHECK(measure_matrix(bench));
  if (!a.goals.empty()) AFTERGLOW_CHECK(measure_goals(bench));
  console.end_progress();
  AFTERGLOW_CHECK(bench::write_report(bench.report, a.out));
  for (const auto& cell : bench.report.cells) print_cell(cell);
  print_goals(bench.report.goals);
  if (a.compare.empty()) return {};
  return compare(bench);
}

void add_options(CLI::App& app, BenchArguments& a) {
  app.add_option("PRESET", a.presets, "Looks to measure");
  app.add_option("--sizes", a.sizes, "Sizes of the picture (default 1920x1080,3840x2160)")->type_name("WxH,…");
  app.add_option("--variants", a.variants,
                 "Ways of execution, as `devices` and --report name them, or plain16f, plain32f, chosen (what `run` "
                 "does), watched (the same, looking for values that are not finite, as `run` does)")
      ->type_name("NAME,…");
  add_repeatable(app, "--vary", a.vary,
                 "Measures each value of a setting; errors are against the preset as it is (repeatable)",
                 "EFFECT.SETTING=VALUE,…");
  a.preset.add_overrides(app);
  a.preset.add_paths(app);
  app.add_option("--scaling", a.scaling, "Also squares of 256, 512, … up to this side, as `run` executes them")
      ->check(CLI::Range(0, 16384))
      ->type_name("SIDE");
  app.add_option("--repeat", a.repeat, "Rounds; medians are of as many (default 9)")->check(CLI::Range(1, 1000));
  app.add_option("--picture", a.picture, "Picture to measure on, scaled (default: a made scene)")->type_name("FILE");
  app.add_option("--goals", a.goals, "Measure the ratios that a file of goals names")->type_name("FILE.json");
  app.add_flag("--reload", a.reload,
               "How long edits take from the save to the new picture: medians of 50 of a value and 50 of a shader, at "
               "1280x720 unless --sizes says otherwise");
  app.add_flag("--temporal", a.temporal,
               "How steady what the looks add is: highlights that drift by parts of a pixel (or the shot of --picture "
               "shot.####.exr), and one scene at the --sizes (default 960x540,1280x720,1920x1080,3840x2160)")
      ->excludes("--reload");
  app.add_flag("--quick", a.quick, "320x180, 3 rounds, two variants: to see that it works");
  app.add_option("-o,--out", a.out, "Folder for bench.json, bench.csv, bench.html, front.svg (default: bench)")
      ->type_name("FOLDER");
  app.add_option("--compare", a.compare, "Print ratios to an older bench.json; exit code 1 beyond --threshold")
      ->type_name("OLD.json");
  app.add_option("--threshold", a.threshold, "How many times as slow is too slow (default 1.15)")
      ->check(CLI::PositiveNumber)
      ->type_name("R");
  a.execution.add_max_error(app);
  a.execution.add_calibration(app);
  a.device.add(app);
}

}  // namespace

Command add_bench_command(CLI::App& program) {
  auto* app = program.add_subcommand("bench", "Measure run time against error");
  auto arguments = std::make_shared<BenchArguments>();
  add_options(*app, *arguments);
  app->footer(
      "Examples:\n"
      "  afterglow bench presets/neon_night.lua -o bench\n"
      "  afterglow bench look.lua --sizes 1280x720 --variants \"plain16f,fused fp32+storage-reads\" --compare "
      "old/bench.json\n"
      "  afterglow bench look.lua --vary glow.max_iterations=4,8,16 --quick\n"
      "All that is measured at one size is prepared first and then run in turns; upload and read-back are not in it.");
  return {app, [arguments](Console& console) { return run_bench(*arguments, console); }};
}

}  // namespace afterglow
