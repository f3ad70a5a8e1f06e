// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "core/file.h"
#include "core/json_text.h"
#include "core/table.h"
#include "core/text.h"
#include "core/version.h"
#include "farm/attempt.h"
#include "farm/status.h"

namespace afterglow::farm {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLargestReport = 1u << 30;
constexpr const char* kNotRun = "not run";

/// Of a node: tries, frames that it made, seconds from the begin to the end of its tries.
struct NodeSum {
  std::size_t tries = 0, frames = 0;
  double seconds = 0;
  std::set<std::string> devices;
};

struct Merge {
  std::string video;                   ///< the one output; empty: pictures
  std::map<std::string, Json> frames;  ///< by output, or by number and input where there is one output
  std::vector<std::string> order;      ///< of `frames`, as chunks have them
  std::map<std::string, NodeSum> nodes;
  std::map<std::string, std::size_t> devices;                          ///< frames made, by device and execution
  std::map<std::pair<std::string, std::string>, std::size_t> skipped;  ///< tries or frames, by name and reason
  std::map<std::string, double> milliseconds;                          ///< sums over frames, by step
  std::size_t unread = 0;
};

std::string text_of(const Json& json, const char* name) {
  return json.is_object() && json.contains(name) && json[name].is_string() ? json[name].get<std::string>() : "";
}

double number_of(const Json& json, const char* name) {
  return json.is_object() && json.contains(name) && json[name].is_number() ? json[name].get<double>() : 0;
}

std::string device_of(const Json& run) {
  const Json session = run.value("session", Json());
  if (!session.is_object()) return {};
  return fmt::format("{} ({}; {})", text_of(session, "device"), text_of(session, "driver"), text_of(session, "choice"));
}

void count_skipped(Merge& merge, const Json& from) {
  if (!from.is_object() || !from.contains("skipped")) return;
  for (const auto& one : from["skipped"]) ++merge.skipped[{text_of(one, "name"), text_of(one, "reason")}];
}

/// A frame that one try made and a later one found up to date keeps what the first says of it.
void take_frame(Merge& merge, Json frame, const std::string& node, NodeSum& sum, std::size_t& made) {
  const std::string state = text_of(frame, "state");
  std::string output = text_of(frame, "output");
  if (output.empty()) return;
  if (!merge.video.empty()) {  // one output of all
    frame["output"] = merge.video;
    output = fmt::format("{} {}", number_of(frame, "frame"), text_of(frame, "input"));
  }
  const auto known = merge.frames.find(output);
  if (known == merge.frames.end()) merge.order.push_back(output);
  const bool was_done = known != merge.frames.end() && text_of(known->second, "state") == "done";
  if (state == "done") {
    ++sum.frames;
    ++made;
    frame["node"] = node;
    count_skipped(merge, frame);
  }
  if (was_done && state != "done" && state != "failed") return;
  if (known != merge.frames.end() && state == kNotRun) return;
  merge.frames[output] = std::move(frame);
}

void take_attempt_report(Merge& merge, const AttemptFile& attempt) {
  const auto text = read_file(attempt.path, kLargestReport);
  const Json json = text ? Json::parse(*text, nullptr, false) : Json();
  if (!json.is_object()) {
    ++merge.unread;
    return;
  }
  const std::string node = text_of(json, "node");
  NodeSum& sum = merge.nodes[node];
  ++sum.tries;
  sum.seconds += std::max(0.0, number_of(json, "ended") - number_of(json, "began"));
  if (!json.contains("run") || !json["run"].is_object()) return;
  const Json& run = json["run"];
  std::size_t made = 0;
  for (const auto& frame : run.value("frames", Json::array())) take_frame(merge, frame, node, sum, made);
  const std::string device = device_of(run);
  if (device.empty() || made == 0) return;
  merge.devices[device] += made;
  sum.devices.insert(device);
  const Json session = run.value("session", Json());
  if (session.contains("skipped"))
    for (const auto& one : session["skipped"]) merge.skipped[{text_of(one, "name"), text_of(one, "reason")}] += made;
}

void sum_times(Merge& merge) {
  for (const auto& [output, frame] : merge.frames)
    if (frame.contains("milliseconds"))
      for (const auto& [step, value] : frame["milliseconds"].items())
        if (value.is_number()) merge.milliseconds[step] += value.get<double>();
}

/// Samples that were not finite: of all frames, by layer or pass.
struct NonFiniteSum {
  std::map<std::string, double> samples;
  std::size_t frames = 0;
};

NonFiniteSum non_finite_of(const Merge& merge) {
  NonFiniteSum sum;
  for (const auto& [output, frame] : merge.frames) {
    if (!frame.contains("non_finite")) continue;
    ++sum.frames;
    for (const auto& [list, key, word] :
         {std::tuple("input", "layer", "input "), std::tuple("passes", "pass", "pass ")})
      for (const auto& one : frame["non_finite"].value(list, Json::array()))
        sum.samples[word + text_of(one, key)] +=
            number_of(one, "nan") + number_of(one, "plus_infinity") + number_of(one, "minus_infinity");
  }
  return sum;
}

std::size_t frames_in(const Merge& merge, const std::string& state) {
  return static_cast<std::size_t>(
      std::ranges::count_if(merge.frames, [&](const auto& frame) { return text_of(frame.second, "state") == state; }));
}

Json merged_json(const Job& job, const JobStatus& status, const Merge& merge) {
  Json out{{"afterglow", version()}, {"job", job.id}, {"folder", job.folder.string()}, {"look", job.look}};
  out["chunks"] = Json{{"all", job.chunks.size()}, {"states", status_line(status)}};
  out["frames_done"] = status.frames_done;
  out["milliseconds"] = merge.milliseconds;
  out["nodes"] = Json::array();
  for (const auto& [name, node] : merge.nodes)
    out["nodes"].push_back(Json{{"name", name},
                                {"tries", node.tries},
                                {"frames", node.frames},
                                {"seconds", node.seconds},
                                {"devices", node.devices}});
  out["devices"] = Json::array();
  for (const auto& [name, frames] : merge.devices) out["devices"].push_back(Json{{"device", name}, {"frames", frames}});
  out["skipped"] = Json::array();
  for (const auto& [what, frames] : merge.skipped)
    out["skipped"].push_back(Json{{"name", what.first}, {"reason", what.second}, {"frames", frames}});
  const NonFiniteSum found = non_finite_of(merge);
  out["non_finite"] = Json{{"frames", found.frames}, {"samples", found.samples}};
  out["frames"] = Json::array();
  for (const auto& output : merge.order) out["frames"].push_back(merge.frames.at(output));
  return out;
}

std::string merged_text(const Job& job, const JobStatus& status, const Merge& merge) {
  std::string out = status_text(job, status, false);
  Table table({"node", "tries", "frames", "seconds", "frames a second"});
  for (const auto& [name, node] : merge.nodes)
    table.add({name, fmt::format("{}", node.tries), fmt::format("{}", node.frames), fmt::format("{:.1f}", node.seconds),
               node.seconds > 0 ? fmt::format("{:.2f}", static_cast<double>(node.frames) / node.seconds) : ""});
  if (!merge.nodes.empty()) out += table.text("  ");
  const std::size_t made = frames_in(merge, "done");
  if (made > 0) {
    out += "a frame:";
    for (const char* step : {"read", "upload", "execute", "read_back", "write"})
      if (const auto at = merge.milliseconds.find(step); at != merge.milliseconds.end())
        out += fmt::format(" {} {:.1f} ms", step, at->second / static_cast<double>(made));
    out += "\n";
  }
  for (const auto& [name, frames] : merge.devices) out += fmt::format("device {}: {} frames\n", name, frames);
  if (merge.devices.size() > 1) out += "pixels of different devices may differ within the documented bounds\n";
  for (const auto& [what, frames] : merge.skipped)
    out += fmt::format("skipped {} in {} frames: {}\n", what.first, frames, what.second);
  const NonFiniteSum found = non_finite_of(merge);
  for (const auto& [where, samples] : found.samples)
    out += fmt::format("not finite: {} samples of {}\n", samples, where);
  for (const auto& output : merge.order)
    if (const std::string error = text_of(merge.frames.at(output), "error"); !error.empty())
      out += fmt::format("failed: {}\n", error.substr(0, error.find('\n')));
  if (merge.unread > 0) out += fmt::format("{} reports could not be read\n", merge.unread);
  return out;
}

}  // namespace

Result<MergedReport> merged_report(const Job& job, const JobStatus& status) {
  AFTERGLOW_TRY(const auto attempts, attempts_of(job));
  Merge merge;
  merge.video = job.video;
  for (const auto& attempt : attempts) take_attempt_report(merge, attempt);
  sum_times(merge);
  return MergedReport{merged_text(job, status, merge), json_text(merged_json(job, status, merge))};
}

}  // namespace afterglow::farm
