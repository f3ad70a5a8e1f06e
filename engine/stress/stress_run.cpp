// SPDX-License-Identifier: MIT
#include "stress/stress_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "core/paths.h"
#include "core/process.h"
#include "core/version.h"

namespace afterglow::stress {
namespace {

constexpr Size kGrowthSize{256, 256}, kBriefGrowthSize{64, 64};

/// Effects by name, presets whole; without any, every effect there is.
Result<std::vector<Subject>> subjects_of(const StressRequest& request, Diagnostics& diagnostics) {
  std::vector<Subject> out;
  if (request.presets.empty() || !request.effects.empty()) {
    AFTERGLOW_TRY(out, subjects_of_effects(request.effects, request.paths, diagnostics));
  }
  for (const auto& name : request.presets) {
    AFTERGLOW_TRY(const std::filesystem::path file, find_preset_file(name, request.paths));
    PresetOptions options;
    options.paths = request.paths;
    AFTERGLOW_TRY(auto look, look_of_preset(file, options, {64, 64}, diagnostics));
    out.push_back({.name = file.stem().string(), .looks = {std::move(look)}, .effect = {}});
  }
  if (out.empty())
    return Error{ErrorKind::script, "no effects were found", "afterglow stress", 0,
                 "an installation with scripts/effects (AFTERGLOW_HOME names its folder), --path, AFTERGLOW_PATH"};
  return out;
}

struct Opened {
  std::unique_ptr<Device> device;
  std::unique_ptr<Harness> harness;
};

Result<Opened> open(const StressRequest& request, Diagnostics& diagnostics) {
  Opened out;
  AFTERGLOW_TRY(out.device, Device::create(request.device, diagnostics));
  out.device->use_pipeline_cache((request.cache_folder / "pipelines").string());
  AFTERGLOW_TRY(out.harness, Harness::create(*out.device, request.cache_folder, diagnostics));
  return out;
}

/// The validation layer's word counts too.
Result<void> check_validation(const Device& device) {
  if (device.validation_errors() == 0) return {};
  return Error{ErrorKind::device, fmt::format("{} Vulkan validation errors; the first: {}", device.validation_errors(),
                                              device.validation_messages().front())};
}

/// Words by which another process of this program tries the same.
std::vector<std::string> same_arguments(const StressRequest& request) {
  std::vector<std::string> out{"stress"};
  for (const auto& preset : request.presets) out.push_back(preset);
  for (const auto& effect : request.effects) out.insert(out.end(), {"--effect", effect});
  for (const auto& path : request.paths) out.insert(out.end(), {"--path", path.string()});
  out.insert(out.end(), {"--seed", std::to_string(request.seed), "--device", request.device.device, "-q"});
  return out;
}

Result<std::vector<ProcessCheck>> ask_other_processes(const StressRequest& request,
                                                      const std::map<std::uint64_t, Hash>& digests,
                                                      const StressEvents& events) {
  constexpr std::size_t kMost = 200;  // arguments of a command line
  std::map<std::uint64_t, Hash> some;
  for (const auto& one : digests)
    if (some.size() < kMost) some.insert(one);
  std::vector<ProcessCheck> out;
  if (some.empty()) return out;
  std::vector<std::string> words = same_arguments(request);
  words.insert(words.begin(), "/proc/self/exe");
  for (const auto& [index, hash] : some) words.insert(words.end(), {"--digests-of", std::to_string(index)});
  for (const char* threads : {"0", "5"}) {
    if (events.interrupted()) return out;
    AFTERGLOW_TRY(const ProcessEnd theirs,
                  run_process(words, {.environment = {{"LP_NUM_THREADS", threads}}, .show_errors = true}));
    if (theirs.code != 0) return Error{ErrorKind::other, fmt::format("'{}' {}", words[0], theirs.text())};
    AFTERGLOW_TRY(auto check,
                  compare_digests(fmt::format("LP_NUM_THREADS={}, another process", threads), some, theirs.out));
    out.push_back(std::move(check));
  }
  return out;
}

Error interrupted_error() { return {ErrorKind::interrupted, "interrupted", {}, 0, {}, {}, {}}; }

Result<void> go_on(const StressEvents& events) {
  return events.interrupted() ? Result<void>(interrupted_error()) : Result<void>();
}

ProgrammeOptions programme_of(const StressRequest& request) {
  ProgrammeOptions out{.seed = request.seed,
                       .cases = request.cases,
                       .trial = request.trial,
                       .seconds = request.seconds,
                       .out = request.out / fmt::format("seed-{}", request.seed),
                       .version = version()};
  if (request.brief && out.cases == 0) out.cases = kBriefCases;
  return out;
}

/// How far the programme is, in what it ends by.
std::pair<std::size_t, std::size_t> share_done(const ProgrammeOptions& options, const Summary& so_far,
                                               std::size_t round) {
  if (options.trial) return {so_far.trials, 1};
  if (options.cases > 0) return {so_far.cases, options.cases};
  if (options.seconds > 0) return {static_cast<std::size_t>(so_far.seconds), static_cast<std::size_t>(options.seconds)};
  return {so_far.trials, round};
}

/// After how many trials it counts that a subject did nothing: those that were asked for by name at once, others when
/// all their settings have had their turn. One trial alone may be any.
std::uint64_t looks_of(const Trials& trials, const StressRequest& request, const std::string& subject) {
  if (request.trial) return std::numeric_limits<std::uint64_t>::max();
  if (!request.effects.empty() || !request.presets.empty()) return 1;
  const auto found = std::ranges::find(trials.subjects(), subject, &Subject::name);
  return found->looks.size();
}

}  // namespace

Result<StressReport> run_stress(const StressRequest& request, Diagnostics& diagnostics, const StressEvents& events) {
  AFTERGLOW_TRY(auto subjects, subjects_of(request, diagnostics));
  Diagnostics quiet;  // settings that are hard to stand are worth a warning each
  AFTERGLOW_TRY(const Opened opened, open(request, quiet));
  const Trials trials(std::move(subjects), search_path_for({}, request.paths), request.seed);
  const ProgrammeOptions options = programme_of(request);
  StressReport report{.version = version(),
                      .device = opened.device->info().name,
                      .driver = opened.device->info().driver,
                      .seed = request.seed};
  const auto step = [&](const Summary& so_far) -> Result<void> {
    AFTERGLOW_CHECK(go_on(events));
    const auto [done, total] = share_done(options, so_far, trials.round());
    events.progress(so_far, done, total);
    return {};
  };
  AFTERGLOW_TRY(report.summary, run_programme(*opened.harness, trials, options, quiet, step, events.found));
  report.never_active =
      never_active(report.summary, [&](const std::string& subject) { return looks_of(trials, request, subject); });
  if (!report.summary.interrupted) {
    AFTERGLOW_TRY(report.processes, ask_other_processes(request, report.summary.digests, events));
  }
  if (!report.summary.interrupted && !request.trial) {
    auto growth = error_growth(*opened.harness, trials.subjects(), request.brief ? kBriefGrowthSize : kGrowthSize,
                               request.brief, request.seed, [&] { return go_on(events); });
    if (growth)
      report.growth = std::move(*growth);
    else if (growth.error().kind != ErrorKind::interrupted)
      return std::move(growth).error();
  }
  AFTERGLOW_CHECK(check_validation(*opened.device));
  return report;
}

Result<Repeated> repeat_case(const std::filesystem::path& folder, const StressRequest& request,
                             Diagnostics& diagnostics) {
  AFTERGLOW_TRY(const Situation situation, read_reproducer(folder, diagnostics));
  Diagnostics quiet;
  AFTERGLOW_TRY(const Opened opened, open(request, quiet));
  // A look that cannot be made any more holds nothing.
  const auto facts = opened.harness->facts(situation.look, situation.picture.color.size(), situation.frame);
  if (!facts) return facts.error();
  AFTERGLOW_TRY(Outcome outcome, run_check(*opened.harness, situation));
  return Repeated{situation.check, std::move(outcome)};
}

Result<std::string> digests_of(const std::vector<std::uint64_t>& wanted, const StressRequest& request,
                               Diagnostics& diagnostics) {
  AFTERGLOW_TRY(auto subjects, subjects_of(request, diagnostics));
  Diagnostics quiet;
  AFTERGLOW_TRY(const Opened opened, open(request, quiet));
  const Trials trials(std::move(subjects), search_path_for({}, request.paths), request.seed);
  std::map<std::uint64_t, Hash> digests;
  for (const std::uint64_t index : wanted) {
    opened.harness->forget();
    AFTERGLOW_TRY(digests[index], digest_of(*opened.harness, trials.at(index), quiet));
  }
  return digests_text(digests);
}

}  // namespace afterglow::stress
