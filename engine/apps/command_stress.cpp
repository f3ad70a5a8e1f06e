// SPDX-License-Identifier: MIT
// `afterglow stress`: tries to break effects and stacks, and keeps what breaks as cases that can be run again.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "apps/command.h"
#include "apps/interrupt.h"
#include "apps/options.h"
#include "apps/output.h"
#include "core/file.h"
#include "core/paths.h"
#include "core/table.h"
#include "core/text.h"
#include "core/version.h"
#include "stress/processes.h"
#include "stress/report.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kShortCases = 1500;
constexpr Size kGrowthSize{256, 256}, kShortGrowthSize{64, 64};

struct StressArguments {
  std::vector<std::string> presets, effects, devices;
  PresetArguments preset;  // --path alone
  DeviceArguments device;  // --validate alone
  std::uint64_t seed = 1, cases = 0;
  std::string duration, report, out = "stress", repeat;
  std::vector<std::string> digests_of;
  bool quick = false, list = false;
};

/// "90", "90s", "10m", "2h" in seconds. Errors: usage.
Result<double> parse_duration(const std::string& text) {
  const auto wrong = [&] {
    return Error{ErrorKind::usage, fmt::format("'{}' is no duration", text), "--for", 0, "30s, 10m, 2h"};
  };
  if (text.empty()) return wrong();
  const char unit = text.back();
  const double factor = unit == 'h' ? 3600 : unit == 'm' ? 60 : 1;
  const std::string number = unit == 'h' || unit == 'm' || unit == 's' ? text.substr(0, text.size() - 1) : text;
  std::size_t end = 0;
  double value = 0;
  try {
    value = std::stod(number, &end);
  } catch (const std::exception&) {
    return wrong();
  }
  if (end != number.size() || !(value > 0) || value > 1e6) return wrong();
  return value * factor;
}

void print_list() {
  Table checks({"check", "of", "what"});
  for (const auto& check : stress::checks())
    checks.add({check.name, check.promise ? "those that promise it" : "every stack", check.doc});
  Table pictures({"picture", "what"});
  for (const auto& kind : stress::picture_kinds()) pictures.add({kind.name, kind.doc});
  output("{}\n{}", checks.text(), pictures.text());
}

std::vector<fs::path> extra_paths(const StressArguments& a) { return {a.preset.paths.begin(), a.preset.paths.end()}; }

/// Effects by name, presets whole; without any, every effect there is.
Result<std::vector<stress::Subject>> subjects_of(const StressArguments& a, Console& console) {
  std::vector<stress::Subject> out;
  if (a.presets.empty() || !a.effects.empty()) {
    AFTERGLOW_TRY(out, stress::subjects_of_effects(a.effects, extra_paths(a), console.diagnostics()));
  }
  for (const auto& name : a.presets) {
    AFTERGLOW_TRY(const fs::path file, find_preset_file(name, extra_paths(a)));
    PresetOptions options;
    options.paths = extra_paths(a);
    AFTERGLOW_TRY(auto look, stress::look_of_preset(file, options, {64, 64}, console.diagnostics()));
    out.push_back({.name = file.stem().string(), .looks = {std::move(look)}, .effect = {}});
  }
  if (out.empty())
    return Error{ErrorKind::script, "no effects were found", "afterglow stress", 0,
                 "an installation with scripts/effects (AFTERGLOW_HOME names its folder), --path, AFTERGLOW_PATH"};
  return out;
}

struct Opened {
  std::unique_ptr<Device> device;
  std::unique_ptr<stress::Harness> harness;
};

Result<Opened> open(const StressArguments& a, const std::string& name, Diagnostics& diagnostics) {
  DeviceArguments device = a.device;
  device.device = name;
  Opened out;
  AFTERGLOW_TRY(const DeviceOptions asked, device.options());
  AFTERGLOW_TRY(out.device, Device::create(asked, diagnostics));
  out.device->use_pipeline_cache((cache_folder() / "pipelines").string());
  AFTERGLOW_TRY(out.harness, stress::Harness::create(*out.device, cache_folder(), diagnostics));
  return out;
}

/// The validation layer's word counts too.
Result<void> check_validation(const Device& device) {
  if (device.validation_errors() == 0) return {};
  return Error{ErrorKind::device, fmt::format("{} Vulkan validation errors; the first: {}", device.validation_errors(),
                                              device.validation_messages().front())};
}

/// --repeat FOLDER: the case again. Errors: other (it still fails).
Result<void> repeat(const StressArguments& a, Console& console) {
  AFTERGLOW_TRY(const stress::Situation situation, stress::read_reproducer(a.repeat, console.diagnostics()));
  Diagnostics quiet;
  AFTERGLOW_TRY(const Opened opened, open(a, a.devices.empty() ? "auto" : a.devices.front(), quiet));
  AFTERGLOW_TRY(const stress::Outcome outcome, stress::run_check(*opened.harness, situation));
  if (!outcome.applies) {
    output("{}: no longer applies: the effect does not promise it for these settings, or refuses them\n",
           situation.check);
    return {};
  }
  if (!outcome.holds) return Error{ErrorKind::other, fmt::format("{}: {}", situation.check, outcome.what), a.repeat};
  output("{}: holds: {:.3g} measured, {:.3g} allowed\n", situation.check, outcome.measured, outcome.allowed);
  return {};
}

/// Words by which another process of this program tries the same.
std::vector<std::string> same_arguments(const StressArguments& a, const std::string& device) {
  std::vector<std::string> out{"stress"};
  for (const auto& preset : a.presets) out.push_back(preset);
  for (const auto& effect : a.effects) out.insert(out.end(), {"--effect", effect});
  for (const auto& path : a.preset.paths) out.insert(out.end(), {"--path", path});
  out.insert(out.end(), {"--seed", std::to_string(a.seed), "--device", device, "-q"});
  return out;
}

/// The other side of it: prints the digests of trials.
Result<void> print_digests(const StressArguments& a, Console& console) {
  AFTERGLOW_TRY(auto subjects, subjects_of(a, console));
  Diagnostics quiet;
  AFTERGLOW_TRY(const Opened opened, open(a, a.devices.empty() ? "auto" : a.devices.front(), quiet));
  const stress::Trials trials(std::move(subjects), search_path_for({}, extra_paths(a)), a.seed);
  std::map<std::uint64_t, Hash> digests;
  for (const auto& text : a.digests_of) {
    if (text.empty() || text.size() > 18 || !std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c); }))
      return Error{ErrorKind::usage, fmt::format("'{}' is no trial", text), "--digests-of"};
    const std::uint64_t index = std::stoull(text);
    opened.harness->forget();
    AFTERGLOW_TRY(digests[index], stress::digest_of(*opened.harness, trials.at(index), quiet));
  }
  output("{}", stress::digests_text(digests));
  return {};
}

Result<std::vector<stress::ProcessCheck>> ask_other_processes(const StressArguments& a, const std::string& device,
                                                              const std::map<std::uint64_t, Hash>& digests) {
  constexpr std::size_t kMost = 200;  // arguments of a command line
  std::map<std::uint64_t, Hash> some;
  for (const auto& one : digests)
    if (some.size() < kMost) some.insert(one);
  std::vector<stress::ProcessCheck> out;
  if (some.empty()) return out;
  std::vector<std::string> arguments = same_arguments(a, device);
  for (const auto& [index, hash] : some) arguments.insert(arguments.end(), {"--digests-of", std::to_string(index)});
  for (const char* threads : {"0", "5"}) {
    if (interrupted()) return out;
    AFTERGLOW_TRY(const std::string theirs,
                  stress::output_of("/proc/self/exe", arguments, {{"LP_NUM_THREADS", threads}}));
    AFTERGLOW_TRY(auto check,
                  stress::compare_digests(fmt::format("LP_NUM_THREADS={}, another process", threads), some, theirs));
    out.push_back(std::move(check));
  }
  return out;
}

Result<stress::StressReport> try_device(const StressArguments& a, const std::string& device, Console& console) {
  AFTERGLOW_TRY(auto subjects, subjects_of(a, console));
  Diagnostics quiet;  // settings that are hard to stand are worth a warning each
  AFTERGLOW_TRY(const Opened opened, open(a, device, quiet));
  const stress::Trials trials(std::move(subjects), search_path_for({}, extra_paths(a)), a.seed);
  stress::ProgrammeOptions options{.seed = a.seed,
                                   .cases = a.cases,
                                   .seconds = 0,
                                   .out = fs::path(a.out) / fmt::format("seed-{}", a.seed),
                                   .version = version()};
  if (!a.duration.empty()) {
    AFTERGLOW_TRY(options.seconds, parse_duration(a.duration));
  }
  if (a.quick && options.cases == 0) options.cases = kShortCases;
  stress::StressReport report{.version = version(),
                              .device = opened.device->info().name,
                              .driver = opened.device->info().driver,
                              .seed = a.seed};
  console.note(fmt::format("seed {}", a.seed));
  const auto total = [&](const stress::Summary& so_far) -> std::pair<std::size_t, std::size_t> {
    if (options.cases > 0) return {so_far.cases, options.cases};
    if (options.seconds > 0)
      return {static_cast<std::size_t>(so_far.seconds), static_cast<std::size_t>(options.seconds)};
    return {so_far.trials, trials.round()};
  };
  const auto step = [&](const stress::Summary& so_far) -> Result<void> {
    if (interrupted()) return interrupt_error();
    const auto [done, all] = total(so_far);
    console.progress(done, all, fmt::format("{} cases, {} failures", so_far.cases, so_far.failures), so_far.seconds);
    return {};
  };
  const auto found = [&](const stress::Finding& f) {
    console.warning(fmt::format("{}: {}: {}{}", f.subject, f.check, f.what,
                                f.folder.empty() ? "" : "; kept in " + f.folder.string()));
  };
  AFTERGLOW_TRY(report.summary, stress::run_programme(*opened.harness, trials, options, quiet, step, found));
  console.end_progress();
  if (!report.summary.interrupted) {
    AFTERGLOW_TRY(report.processes, ask_other_processes(a, device, report.summary.digests));
    auto growth = stress::error_growth(
        *opened.harness, trials.subjects(), a.quick ? kShortGrowthSize : kGrowthSize, a.quick, a.seed,
        [&]() -> Result<void> { return interrupted() ? Result<void>(interrupt_error()) : Result<void>(); });
    if (growth)
      report.growth = std::move(*growth);
    else if (growth.error().kind != ErrorKind::interrupted)
      return std::move(growth).error();
  }
  AFTERGLOW_CHECK(check_validation(*opened.device));
  return report;
}

Result<void> run_stress(const StressArguments& a, Console& console) {
  if (a.list) {
    print_list();
    return {};
  }
  if (!a.repeat.empty()) return repeat(a, console);
  if (!a.digests_of.empty()) return print_digests(a, console);
  std::uint64_t failures = 0;
  bool clean = true;
  for (const auto& device : a.devices.empty() ? std::vector<std::string>{"auto"} : a.devices) {
    AFTERGLOW_TRY(const auto report, try_device(a, device, console));
    output("{}", stress::report_text(report));
    std::fflush(stdout);
    const std::string file =
        a.devices.size() > 1 ? fs::path(a.report).replace_extension(device + ".json").string() : a.report;
    if (!a.report.empty()) AFTERGLOW_CHECK(write_file_atomically(file, stress::report_json(report)));
    failures += report.summary.failures;
    clean = clean && report.clean();
    if (interrupted()) return interrupt_error();
  }
  if (clean) return {};
  return Error{ErrorKind::other, fmt::format("{} cases failed (seed {})", failures, a.seed), "afterglow stress"};
}

void add_options(CLI::App& app, StressArguments& a) {
  app.add_option("PRESET", a.presets, "Whole looks to try; without any, and without --effect: every effect");
  add_repeatable(app, "--effect", a.effects, "Only this effect (repeatable)", "NAME");
  a.preset.add_paths(app);
  app.add_option("--seed", a.seed, "What is tried is made from this number alone (default 1)")->type_name("N");
  app.add_option("--cases", a.cases, "End after so many cases")->check(CLI::PositiveNumber)->type_name("N");
  app.add_option("--for", a.duration,
                 "End after this time: 30s, 10m, 2h (default: when every effect has had all its limits)")
      ->type_name("TIME");
  app.add_flag("--short", a.quick,
               fmt::format("{} cases, and less of the growth of errors: under a minute on two cores", kShortCases));
  app.add_option("--report", a.report, "Write everything as JSON")->type_name("FILE.json");
  app.add_option("-o,--out", a.out, "Folder for cases that fail (default: stress)")->type_name("FOLDER");
  app.add_option("--repeat", a.repeat, "Run a case again that was kept; exit code 1 when it still fails")
      ->type_name("FOLDER");
  app.add_flag("--list", a.list, "List checks and pictures");
  add_repeatable(app, "--device", a.devices, "Device to try, see `devices` (repeatable; default auto)", "NAME");
  a.device.add_validate(app);
  add_repeatable(app, "--digests-of", a.digests_of, "", "N")
      ->group("");  // how the program asks another process of itself
}

}  // namespace

Command add_stress_command(CLI::App& program) {
  auto* app = program.add_subcommand("stress", "Try to break effects and looks with hard pictures and settings");
  auto arguments = std::make_shared<StressArguments>();
  add_options(*app, *arguments);
  app->footer(
      "Examples:\n"
      "  afterglow stress --short\n"
      "  afterglow stress --effect my_effect --path . --for 10m --seed 7\n"
      "  afterglow stress look.lua --for 1h --report stress.json\n"
      "  afterglow stress --repeat stress/seed-7/my_effect-finite-12-render\n"
      "Exit code 0: everything held; 1: something did not. Effects say in `holds` what else to hold them to.");
  return {app, [arguments](Console& console) { return run_stress(*arguments, console); }};
}

}  // namespace afterglow
