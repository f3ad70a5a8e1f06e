// SPDX-License-Identifier: MIT
#include "stress/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

namespace afterglow::stress {
namespace {

using nlohmann::json;

/// JSON has no infinity.
json number(double value) { return std::isfinite(value) ? json(value) : json(fmt::format("{}", value)); }

json as_json(const Tally& tally) {
  return {{"cases", tally.cases},
          {"failures", tally.failures},
          {"worst", number(tally.worst)},
          {"allowed", number(tally.allowed)}};
}

json as_json(const ErrorMeasure& error) {
  return {{"percentile", number(error.percentile)}, {"worst", number(error.worst)}, {"rms", number(error.rms)}};
}

json as_json(const Finding& f) {
  return {{"subject", f.subject},        {"check", f.check},      {"what", f.what},          {"stack", f.stack},
          {"picture", f.picture},        {"width", f.size.width}, {"height", f.size.height}, {"trial", f.trial},
          {"folder", f.folder.string()}, {"tries", f.tries}};
}

std::string finding_text(const Finding& f) {
  std::string out = fmt::format("{}: {}: {}\n  {} on {}x{} ({}), trial {}\n", f.subject, f.check, f.what, f.stack,
                                f.size.width, f.size.height, f.picture, f.trial);
  if (!f.folder.empty()) out += fmt::format("  again: afterglow stress --repeat {}\n", f.folder.string());
  return out;
}

}  // namespace

std::string NeverActive::text() const {
  return fmt::format("{} was never active in {} trial{}: {}", subject, trials, trials == 1 ? "" : "s", reason);
}

std::vector<NeverActive> never_active(const Summary& summary,
                                      const std::function<std::uint64_t(const std::string& subject)>& enough) {
  std::vector<NeverActive> out;
  for (const auto& [subject, activity] : summary.activity)
    if (activity.active == 0 && !activity.reason.empty() &&
        activity.trials >= std::max<std::uint64_t>(enough(subject), 1))
      out.push_back({subject, activity.trials, activity.reason});
  return out;
}

bool StressReport::clean() const {
  return summary.failures == 0 && never_active.empty() &&
         std::ranges::all_of(processes, [](const auto& p) { return p.different.empty(); });
}

std::string report_text(const StressReport& report) {
  const Summary& s = report.summary;
  std::string out = fmt::format("{} with {}, seed {}\n\n{:<16}{:>9}{:>10}  {:<10}{:<10}{}\n", report.device,
                                report.driver, report.seed, "check", "cases", "failures", "worst", "allowed", "what");
  for (const Check& check : checks()) {
    const auto found = s.checks.find(check.name);
    if (found == s.checks.end()) continue;
    const Tally& t = found->second;
    out += fmt::format("{:<16}{:>9}{:>10}  {:<10.2g}{:<10.2g}{}\n", check.name, t.cases, t.failures, t.worst, t.allowed,
                       check.doc);
  }
  for (const auto& p : report.processes)
    out += fmt::format("{:<16}{:>9}{:>10}  {}\n", "processes", p.compared, p.different.size(),
                       "the same bytes with " + p.how);
  out += fmt::format(
      "\n{} cases in {} trials, {} failures; {} looks were refused by their effects or too large; {:.1f} s, {:.0f} "
      "cases a second\n",
      s.cases, s.trials, s.failures, s.refused, s.seconds, static_cast<double>(s.cases) / std::max(s.seconds, 1e-3));
  if (!report.growth.empty())
    out += "\nError against double precision by levels (99.99 % of samples, and the worst):\n" +
           growth_text(report.growth);
  if (!report.never_active.empty()) out += "\n";
  for (const auto& one : report.never_active) out += one.text() + "\n";
  if (!s.findings.empty()) out += "\n";
  for (const auto& f : s.findings) out += finding_text(f);
  for (const auto& p : report.processes)
    for (const auto trial : p.different) out += fmt::format("trial {} gives other bytes with {}\n", trial, p.how);
  return out;
}

std::string report_json(const StressReport& report) {
  const Summary& s = report.summary;
  json out{{"version", report.version},    {"device", report.device},    {"driver", report.driver},
           {"seed", report.seed},          {"trials", s.trials},         {"cases", s.cases},
           {"failures", s.failures},       {"refused", s.refused},       {"seconds", s.seconds},
           {"interrupted", s.interrupted}, {"checks", json::object()},   {"subjects", json::object()},
           {"findings", json::array()},    {"processes", json::array()}, {"error_growth", json::array()},
           {"never_active", json::array()}};
  for (const auto& one : report.never_active)
    out["never_active"].push_back({{"subject", one.subject}, {"trials", one.trials}, {"reason", one.reason}});
  for (const auto& [name, tally] : s.checks) out["checks"][name] = as_json(tally);
  for (const auto& [subject, checks] : s.subjects)
    for (const auto& [name, tally] : checks) out["subjects"][subject][name] = as_json(tally);
  for (const auto& f : s.findings) out["findings"].push_back(as_json(f));
  for (const auto& p : report.processes)
    out["processes"].push_back({{"how", p.how}, {"compared", p.compared}, {"different", p.different}});
  for (const auto& row : report.growth) {
    json one{{"effect", row.effect},
             {"variant", row.variant},
             {"picture", row.picture},
             {"levels", row.levels},
             {"fp32", as_json(row.fp32)}};
    if (row.has_fp16) one["fp16"] = as_json(row.fp16);
    out["error_growth"].push_back(std::move(one));
  }
  return out.dump(2) + "\n";
}

std::string digests_text(const std::map<std::uint64_t, Hash>& digests) {
  std::string out;
  for (const auto& [trial, hash] : digests) out += fmt::format("{} {}\n", trial, hash.hex());
  return out;
}

Result<ProcessCheck> compare_digests(const std::string& how, const std::map<std::uint64_t, Hash>& own,
                                     const std::string& theirs) {
  ProcessCheck out{.how = how, .compared = 0, .different = {}};
  std::istringstream lines(theirs);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::uint64_t trial = 0;
    std::string hash;
    const auto known = words >> trial >> hash ? own.find(trial) : own.end();
    if (known == own.end())
      return Error{ErrorKind::other, fmt::format("another process says '{}', which is no result", line)};
    ++out.compared;
    if (known->second.hex() != hash) out.different.push_back(trial);
  }
  if (out.compared != own.size())
    return Error{ErrorKind::other, fmt::format("another process made {} of {} results", out.compared, own.size())};
  return out;
}

}  // namespace afterglow::stress
