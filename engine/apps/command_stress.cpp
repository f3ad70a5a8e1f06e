// SPDX-License-Identifier: MIT
// `afterglow stress`: tries to break effects and stacks, and keeps what breaks as cases that can be run again.
#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "apps/command.h"
#include "apps/interrupt.h"
#include "apps/output.h"
#include "apps/stress_arguments.h"
#include "core/table.h"
#include "core/written_files.h"

namespace afterglow {
namespace {

void print_list() {
  Table checks({"check", "of", "what"});
  for (const auto& check : stress::checks())
    checks.add({check.name, check.promise ? "those that promise it" : "every stack", check.doc});
  checks.add({"processes", "every stack", "other processes, with other numbers of threads, make the same bytes"});
  Table pictures({"picture", "what"});
  for (const auto& kind : stress::picture_kinds()) pictures.add({kind.name, kind.doc});
  output("{}\n{}", checks.text(), pictures.text());
}

stress::StressEvents events_of(Console& console) {
  return {.progress =
              [&console](const stress::Summary& so_far, std::size_t done, std::size_t total) {
                console.progress(done, total, fmt::format("{} cases, {} failures", so_far.cases, so_far.failures),
                                 so_far.seconds);
              },
          .found =
              [&console](const stress::Finding& f) {
                console.warning(fmt::format("{}: {}: {}{}", f.subject, f.check, f.what,
                                            f.folder.empty() ? "" : "; kept in " + f.folder.string()));
              },
          .interrupted = interrupted};
}

/// --repeat FOLDER: the case again. Errors: other (it still fails).
Result<void> repeat(const StressArguments& a, const stress::StressRequest& request, Console& console) {
  AFTERGLOW_TRY(const auto repeated, stress::repeat_case(*a.repeat, request, console.diagnostics()));
  const auto& [check, outcome] = repeated;
  if (!outcome.applies) {
    output("{}: no longer applies: the effect does not promise it for these settings\n", check);
    return {};
  }
  if (!outcome.holds) return Error{ErrorKind::other, fmt::format("{}: {}", check, outcome.what), *a.repeat};
  output("{}: holds: {:.3g} measured, {:.3g} allowed\n", check, outcome.measured, outcome.allowed);
  return {};
}

/// --digests-of: what another process of this program asks for.
Result<void> print_digests(const StressArguments& a, const stress::StressRequest& request, Console& console) {
  AFTERGLOW_TRY(const auto trials, a.trials());
  AFTERGLOW_TRY(const std::string text, stress::digests_of(trials, request, console.diagnostics()));
  output("{}", text);
  return {};
}

Result<void> run_stress(const StressArguments& a, Console& console) {
  if (a.list) {
    print_list();
    return {};
  }
  const auto devices = a.devices.empty() ? std::vector<std::string>{"auto"} : a.devices;
  AFTERGLOW_TRY(const auto first, a.request(devices.front()));
  if (a.repeat) return repeat(a, first, console);
  if (!a.digests_of.empty()) return print_digests(a, first, console);
  keep_standard_output_for({a.report});
  for (const auto& device : devices) {
    const SideFile report{"--report", a.report.empty() ? "" : a.report_file(device)};
    AFTERGLOW_CHECK(check_written({&report, 1}, {}, {}));
  }
  constexpr unsigned kSecondsToEndATrial = 30;  // a case that fails is being made small: hours of work end in a report
  allow_to_end(kSecondsToEndATrial);
  std::uint64_t failures = 0;
  std::size_t never = 0;
  bool clean = true;
  for (const auto& device : devices) {
    console.note(fmt::format("seed {}", a.seed));
    AFTERGLOW_TRY(const auto request, a.request(device));
    auto report = stress::run_stress(request, console.diagnostics(), events_of(console));
    console.end_progress();
    if (!report) return std::move(report).error();
    output("{}", stress::report_text(*report));
    std::fflush(stdout);
    if (!a.report.empty()) AFTERGLOW_CHECK(output_file(a.report_file(device), stress::report_json(*report)));
    failures += report->summary.failures;
    never += report->never_active.size();
    for (const auto& one : report->never_active) console.warning(one.text());
    clean = clean && report->clean();
    if (interrupted()) return interrupt_error();
  }
  if (clean) return {};
  if (failures == 0 && never > 0)
    return Error{ErrorKind::other, "not everything was tried: see what was never active", "afterglow stress"};
  return Error{ErrorKind::other, fmt::format("{} cases failed (seed {})", failures, a.seed), "afterglow stress"};
}

}  // namespace

Command add_stress_command(CLI::App& program) {
  auto* app = program.add_subcommand("stress", "Try to break effects and looks with hard pictures and settings");
  auto arguments = std::make_shared<StressArguments>();
  arguments->add(*app);
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
