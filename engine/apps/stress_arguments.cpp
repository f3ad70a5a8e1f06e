// SPDX-License-Identifier: MIT
#include "apps/stress_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/ascii.h"
#include "core/paths.h"
#include "core/utf8.h"

namespace afterglow {
namespace {

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

}  // namespace

void StressArguments::add(CLI::App& app) {
  app.add_option("PRESET", presets, "Whole looks to try; without any, and without --effect: every effect");
  add_repeatable(app, "--effect", effects, "Only this effect (repeatable)", "NAME");
  preset.add_paths(app);
  app.add_option("--seed", seed, "What is tried is made from this number alone (default 1)")->type_name("N");
  app.add_option("--cases", cases, "End after so many cases")->check(above_zero())->type_name("N");
  app.add_option("--trial", trial, "Only the trial of this number, as reports and kept cases name it")->type_name("N");
  app.add_option("--for", duration,
                 "End after this time: 30s, 10m, 2h (default: when every effect has had all its limits)")
      ->type_name("TIME");
  app.add_flag(
      "--short", quick,
      fmt::format("Some {} cases, and less of the growth of errors: under a minute on two cores", stress::kBriefCases));
  app.add_option("--report", report, "Write everything as JSON")->type_name("FILE.json");
  app.add_option("-o,--out", folder, "Folder for cases that fail (default: stress)")->type_name("FOLDER");
  app.add_option("--repeat", repeat, "Run a case again that was kept; exit code 1 when it still fails")
      ->type_name("FOLDER");
  app.add_flag("--list", list, "List checks and pictures");
  add_repeatable(app, "--device", devices, "Device to try, see `devices` (repeatable; default auto)", "NAME");
  device.add_validate(app);
  add_repeatable(app, "--digests-of", digests_of, "", "N")
      ->group("");  // how the program asks another process of itself
}

Result<stress::StressRequest> StressArguments::request(const std::string& name) const {
  AFTERGLOW_CHECK(preset.check_paths());
  stress::StressRequest out{.presets = {},
                            .effects = effects,
                            .paths = {preset.paths.begin(), preset.paths.end()},
                            .device = {},
                            .cache_folder = cache_folder(),
                            .seed = seed,
                            .cases = cases,
                            .trial = trial,
                            .seconds = 0,
                            .brief = quick,
                            .out = folder};
  for (const std::string& look : presets) {
    AFTERGLOW_TRY(const std::filesystem::path file, named_preset(look, preset.paths));
    out.presets.push_back(file.string());
  }
  DeviceArguments asked = device;
  asked.device = name;
  AFTERGLOW_TRY(out.device, asked.options());
  if (duration) {
    AFTERGLOW_TRY(out.seconds, parse_duration(*duration));
  }
  std::vector<std::string> named = presets;
  std::ranges::copy(preset.paths, std::back_inserter(named));
  named.push_back(folder);
  for (const auto& path : named) {
    const std::string whole = std::filesystem::absolute(path).string();
    if (utf8_text(whole) != whole)
      return Error{ErrorKind::usage, "names must be UTF-8, for cases to be repeated by them", whole};
  }
  return out;
}

Result<std::vector<std::uint64_t>> StressArguments::trials() const {
  std::vector<std::uint64_t> out;
  for (const auto& text : digests_of) {
    if (text.empty() || text.size() > 18 || !std::ranges::all_of(text, is_digit))
      return Error{ErrorKind::usage, fmt::format("'{}' is no trial", text), "--digests-of"};
    out.push_back(std::stoull(text));
  }
  return out;
}

std::string StressArguments::report_file(const std::string& name) const {
  if (devices.size() < 2) return report;
  return std::filesystem::path(report).replace_extension(name + ".json").string();
}

}  // namespace afterglow
