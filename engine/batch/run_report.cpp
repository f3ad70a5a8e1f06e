// SPDX-License-Identifier: MIT
#include "batch/run_report.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <thread>

#include "core/json_text.h"
#include "core/table.h"
#include "core/text.h"
#include "core/version.h"
#include "image/sequence.h"

namespace afterglow {
namespace {

using Json = nlohmann::ordered_json;

std::size_t count(const RunReport& report, FrameRecord::State state) {
  return static_cast<std::size_t>(
      std::count_if(report.frames.begin(), report.frames.end(), [&](const auto& f) { return f.state == state; }));
}

/// Mean over the frames that were made.
template <class Value>
double mean(const RunReport& report, Value value) {
  double sum = 0;
  for (const auto& frame : report.frames)
    if (frame.state == FrameRecord::State::done) sum += value(frame);
  return sum / static_cast<double>(std::max<std::size_t>(1, count(report, FrameRecord::State::done)));
}

struct Step {
  const char* name;
  double milliseconds;
  std::string note;
};

/// Mean of one of the steps.
double mean_step(const RunReport& report, double FrameSteps::*step) {
  return mean(report, [step](const FrameRecord& frame) { return frame.steps.*step; });
}

/// "a frame: 2.0 from its file, 11.5 decode"
std::string parts_text(const RunReport& report, double whole, double FrameSteps::*part, const char* name,
                       const char* rest) {
  const double milliseconds = mean_step(report, part);
  return fmt::format("a frame: {} {:.1f}, {} {:.1f}", name, milliseconds, rest, std::max(0.0, whole - milliseconds));
}

/// The steps in the order of work.
std::vector<Step> steps(const RunReport& report) {
  const SessionTimes times = report.session ? report.session->times : SessionTimes{};
  const double read = mean_step(report, &FrameSteps::read), write = mean_step(report, &FrameSteps::write);
  return {
      {"start-up", report.startup, "libraries and device; scripts not counted"},
      {"script", times.script, ""},
      {"compile", times.compile, "shaders and pipelines"},
      {"plan", mean_step(report, &FrameSteps::plan), "a frame: its header, and the preset for it"},
      {"read", read, parts_text(report, read, &FrameSteps::decode, "decode", "file")},
      {"upload", mean(report, [](const auto& f) { return f.times.upload; }), "a frame"},
      {"execute", mean(report, [](const auto& f) { return f.times.execute; }), "a frame"},
      {"read-back", mean(report, [](const auto& f) { return f.times.readback; }), "a frame"},
      {"write", write, parts_text(report, write, &FrameSteps::encode, "encode", "file")},
  };
}

/// "a frame" goes without saying where there is one.
std::string note_of(const Step& step, std::size_t done) {
  if (done > 1 || !step.note.starts_with("a frame")) return step.note;
  return step.note.size() > 9 ? step.note.substr(9) : "";
}

double processors_used(const RunReport& report) {
  const double all = report.frames_wall * std::max(1u, std::thread::hardware_concurrency());
  return all > 0 ? report.processors / all : 0;
}

/// How fast frames came, and what they waited for.
std::string pace_text(const RunReport& report, std::size_t done) {
  const double used = processors_used(report), frame = report.frames_wall / static_cast<double>(done);
  const double read = mean_step(report, &FrameSteps::waited_read), write = mean_step(report, &FrameSteps::waited_write);
  const double device = mean(report, [](const auto& f) { return f.times.waited; });
  constexpr double kBusy = 0.9, kMuch = 0.2;
  const char* limit = used >= kBusy                            ? "the processors are the limit"
                      : read >= kMuch * frame && read >= write ? "reading is the limit"
                      : write >= kMuch * frame                 ? "writing is the limit"
                      : device >= kMuch * frame                ? "the device is the limit"
                                                               : "the work between reading and writing is the limit";
  return fmt::format(
      "pace: {:.2f} frames a second; {:.0f} % of {} processors used; each frame waited {:.1f} ms to be read, {:.1f} ms "
      "for others to "
      "be written: {}\n",
      1000 / std::max(frame, 1e-3), 100 * used, std::max(1u, std::thread::hardware_concurrency()), read, write, limit);
}

const FrameRecord* last_done(const RunReport& report) {
  for (auto frame = report.frames.rbegin(); frame != report.frames.rend(); ++frame)
    if (frame->state == FrameRecord::State::done) return &*frame;
  return nullptr;
}

std::string passes_text(const FrameRecord& frame) {
  if (frame.times.kernels.empty()) return {};
  Table table({"pass", "ms"});
  for (const auto& kernel : frame.times.kernels) table.add({kernel.name, fmt::format("{:.3f}", kernel.milliseconds)});
  const char* how = frame.times.separate_submissions
                        ? "\npasses of the last frame, each submitted alone (not part of the figures above)\n"
                        : "\npasses of the last frame, by the device's timestamps\n";
  return how + table.text("  ");
}

/// Where effects that look back began anew.
std::string shots_text(const RunReport& report) {
  std::vector<int> frames;
  for (const auto& frame : report.frames)
    if (frame.begins_shot && frame.state == FrameRecord::State::done) frames.push_back(frame.job.frame);
  std::ranges::sort(frames);
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames.empty() ? "" : fmt::format("shots begin at frames {}\n", frames_text(frames));
}

std::span<const Skipped> skips_of(const FrameRecord& frame) {
  return frame.skipped ? std::span<const Skipped>(*frame.skipped) : std::span<const Skipped>();
}

/// What single frames did not run, each reason once, with the number of frames.
std::string skipped_in_frames_text(const RunReport& report) {
  std::vector<std::pair<Skipped, std::size_t>> found;
  for (const auto& frame : report.frames) {
    if (frame.state != FrameRecord::State::done) continue;
    for (const auto& skipped : skips_of(frame)) {
      auto at = std::ranges::find(found, skipped, [](const auto& f) -> const Skipped& { return f.first; });
      if (at == found.end()) at = found.insert(found.end(), {skipped, 0});
      ++at->second;
    }
  }
  const std::size_t done = count(report, FrameRecord::State::done);
  std::string out;
  for (const auto& [skipped, frames] : found) {
    const std::string where = frames == done ? "" : fmt::format(" in {} of {} frames", frames, done);
    out += fmt::format("skipped {}{}: {}\n", skipped.name, where, skipped.reason);
  }
  return out;
}

Json frame_json(const FrameRecord& frame) {
  static constexpr const char* kStates[] = {"not run", "done", "up to date", "failed"};
  Json out{{"frame", frame.job.frame},
           {"input", frame.job.input.string()},
           {"output", frame.job.output.string()},
           {"state", kStates[static_cast<int>(frame.state)]}};
  if (frame.error) out["error"] = frame.error->text();
  if (auto found = non_finite_json(frame.non_finite); !found.empty()) out["non_finite"] = std::move(found);
  if (auto found = overflows_json(frame.non_finite); !found.empty()) out["beyond_half_floats"] = std::move(found);
  if (frame.state != FrameRecord::State::done) return out;
  if (frame.begins_shot) out["begins_shot"] = true;
  if (frame.taken)
    for (const auto& [input, channels] : *frame.taken) out["channels"][input] = channels;
  out["width"] = frame.size.width;
  out["height"] = frame.size.height;
  const FrameSteps& steps = frame.steps;
  out["milliseconds"] = Json{{"plan", steps.plan},
                             {"read", steps.read},
                             {"decode", steps.decode},
                             {"upload", frame.times.upload},
                             {"execute", frame.times.execute},
                             {"read_back", frame.times.readback},
                             {"encode", steps.encode},
                             {"write", steps.write},
                             {"waited_read", steps.waited_read},
                             {"waited_write", steps.waited_write}};
  for (const auto& kernel : frame.times.kernels)
    out["passes"].push_back(Json{{"name", kernel.name}, {"milliseconds", kernel.milliseconds}});
  for (const auto& skipped : skips_of(frame))
    out["skipped"].push_back(Json{{"name", skipped.name}, {"reason", skipped.reason}});
  if (!frame.times.kernels.empty()) out["passes_submitted_alone"] = frame.times.separate_submissions;
  return out;
}

Json session_json(const SessionReport& session) {
  Json out{{"preset", session.preset},
           {"device", session.device},
           {"driver", session.driver},
           {"choice", execution_name(session.choice.execution)},
           {"choice_from", session.choice.from},
           {"storage", session.choice.execution.storage == Storage::fp16 ? "fp16" : "fp32"},
           {"reference", session.reference},
           {"hardware_filter", session.choice.execution.hardware_filter},
           {"max_error", session.choice.max_error},
           {"kernels", session.kernels},
           {"skipped", Json::array()},
           {"image_memory", Json{{"shared", session.memory.arena},
                                 {"unshared", session.memory.sum},
                                 {"least", session.memory.lower_bound},
                                 {"histories", session.memory.histories}}},
           {"clamped_samples", session.clamped}};
  for (const auto& skipped : session.skipped)
    out["skipped"].push_back(Json{{"name", skipped.name}, {"reason", skipped.reason}});
  return out;
}

}  // namespace

double processor_milliseconds() {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  const auto milliseconds = [](const timeval& time) {
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_usec);
  };
  return milliseconds(usage.ru_utime) + milliseconds(usage.ru_stime);
}

std::uint64_t peak_memory() {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::string report_text(const RunReport& report, bool passes) {
  std::string out;
  if (report.session)
    out += fmt::format("{} on {} ({}; {})\n", report.session->preset, report.session->device,
                       execution_name(report.session->choice.execution), report.session->choice.from);
  const std::size_t done = count(report, FrameRecord::State::done);
  out += fmt::format("frames: {} done, {} up to date, {} failed\n", done, count(report, FrameRecord::State::up_to_date),
                     count(report, FrameRecord::State::failed));
  if (report.pre_roll > 0) out += fmt::format("pre-roll: {} earlier frames, not written\n", report.pre_roll);
  out += shots_text(report);
  Table table({"step", "ms", ""});
  for (const auto& step : steps(report))
    table.add({step.name, fmt::format("{:.1f}", step.milliseconds), note_of(step, done)});
  table.add({"wall", fmt::format("{:.1f}", report.wall), "from start to end; steps overlap"});
  out += table.text("  ");
  if (done > 1) out += pace_text(report, done);
  out += fmt::format("memory: {} at the peak, {} estimated beforehand", memory_text(peak_memory()),
                     memory_text(report.memory_needed));
  if (report.session && report.session->memory.sum > 0)
    out += fmt::format("; passes share {} ({} if they did not)", memory_text(report.session->memory.arena),
                       memory_text(report.session->memory.sum));
  out += "\n";
  if (report.session) {
    for (const auto& skipped : report.session->skipped)
      out += fmt::format("skipped {}: {}\n", skipped.name, skipped.reason);
    out += skipped_in_frames_text(report);
    if (report.session->clamped > 0)
      out += fmt::format("{} samples of the last frame were held at ±65504 (half floats)\n", report.session->clamped);
  }
  if (const FrameRecord* frame = passes ? last_done(report) : nullptr) out += passes_text(*frame);
  return out;
}

std::string report_json(const RunReport& report) {
  Json out{{"afterglow", version()}};
  out["session"] = report.session ? session_json(*report.session) : Json(nullptr);
  for (const auto& step : steps(report)) out["milliseconds"][step.name] = step.milliseconds;
  out["milliseconds"]["decode"] = mean_step(report, &FrameSteps::decode);
  out["milliseconds"]["encode"] = mean_step(report, &FrameSteps::encode);
  out["milliseconds"]["waited_read"] = mean_step(report, &FrameSteps::waited_read);
  out["milliseconds"]["waited_write"] = mean_step(report, &FrameSteps::waited_write);
  out["milliseconds"]["frames_wall"] = report.frames_wall;
  out["milliseconds"]["processors"] = report.processors;
  out["milliseconds"]["wall"] = report.wall;
  out["memory"] = Json{{"peak", peak_memory()}, {"estimated", report.memory_needed}};
  out["pre_roll"] = report.pre_roll;
  out["frames"] = Json::array();
  for (const auto& frame : report.frames) out["frames"].push_back(frame_json(frame));
  return json_text(out);
}

}  // namespace afterglow
