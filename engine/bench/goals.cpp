// SPDX-License-Identifier: MIT
#include "bench/goals.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/command_time.h"
#include "bench/picture.h"
#include "core/file.h"
#include "exec/timing.h"
#include "image/writer.h"
#include "session/session.h"

namespace afterglow::bench {
namespace {

namespace fs = std::filesystem;

/// A term made ready. Addresses must stay: what is recorded refers to the pictures.
struct Contestant {
  Picture picture;
  DevicePicture on_device;
  PreparedStack stack;
  KernelWork copy;
  std::unique_ptr<Session> session;

  Measured measured(const GoalTerm& term) {
    if (term.copy) return [this] { return copy.work().run(); };
    if (!term.frame) return [this] { return stack.work().run(); };
    return [this]() -> Result<double> {
      Picture frame = picture;
      AFTERGLOW_CHECK(session->process(frame));
      return session->report().times.frame.execute;
    };
  }
};

Picture lit_picture(Size size, double light) {
  Picture picture = make_picture(size);
  for (std::size_t i = 0; light != 1 && i < picture.color.pixels.size(); ++i)
    if (i % 4 != 3) picture.color.pixels[i] *= static_cast<float>(light);
  return picture;
}

Result<void> prepare(Device& device, const StackOptions& base, const GoalTerm& term, Size size, Contestant& out,
                     Diagnostics& diagnostics) {
  out.picture = lit_picture(term.size.value_or(size), term.light);
  if (term.copy) {
    AFTERGLOW_TRY(out.on_device, DevicePicture::create(device, out.picture, {}));
    KernelCompiler compiler(base.cache_folder.empty() ? "" : base.cache_folder / "shaders");
    AFTERGLOW_TRY(out.copy,
                  KernelWork::create(device, compiler, {}, out.on_device.source(), out.on_device.result(), "copy"));
    return {};
  }
  if (term.frame) {
    SessionOptions options;
    options.device.device = device.info().name;
    options.stack = base;
    options.stack.choice = term.choice;
    options.stack.preset.overrides = term.overrides;
    AFTERGLOW_TRY(out.session, Session::open(term.look, options, diagnostics));
    return {};
  }
  Variant variant{.choice = term.choice, .overrides = term.overrides};
  if (term.display) variant.encoding.emplace();
  AFTERGLOW_TRY(out.stack, PreparedStack::create(device, term.look, base, variant, out.picture, diagnostics));
  AFTERGLOW_TRY(out.on_device, DevicePicture::create(device, out.picture, out.stack.picture_kind()));
  return out.stack.record(device, out.on_device);
}

Result<double> measure_ratio(Device& device, const StackOptions& base, const Goal& goal, Diagnostics& diagnostics,
                             const Step& step) {
  std::vector<GoalTerm> terms = goal.over;
  terms.insert(terms.end(), goal.under.begin(), goal.under.end());
  std::vector<std::unique_ptr<Contestant>> contestants;
  std::vector<Measured> all;
  for (const auto& term : terms) {
    contestants.push_back(std::make_unique<Contestant>());
    AFTERGLOW_CHECK(prepare(device, base, term, goal.size, *contestants.back(), diagnostics));
    all.push_back(contestants.back()->measured(term));
  }
  AFTERGLOW_TRY(const auto spreads, run_in_turns(all, goal.repeat, [&](int round) {
                  return step(fmt::format("{}: round {} of {}", goal.name, round, goal.repeat));
                }));
  double over = 0, under = 0;
  for (std::size_t i = 0; i < terms.size(); ++i)
    (i < goal.over.size() ? over : under) += terms[i].times * spreads[i].median;
  if (under <= 0) return Error{ErrorKind::other, "the sum to divide by is not above 0"};
  return over / under;
}

/// Each another picture: frames that repeat one before are not run.
Result<void> write_frames(const Goal& goal, const GoalTools& tools, Diagnostics& diagnostics) {
  Picture picture = make_picture(goal.size);
  WriteOptions half;
  half.type = SampleType::half;
  for (int i = 1; i <= goal.command->frames; ++i) {
    picture.color.pixels[0] = static_cast<float>(i) / 1024;
    AFTERGLOW_CHECK(write_picture(picture, tools.folder / fmt::format("in.{:04}.exr", i), half, diagnostics));
  }
  return {};
}

std::vector<std::string> words_of(const GoalCommand& command, const std::filesystem::path& folder) {
  if (command.check) return {"check", command.look.string()};
  std::vector<std::string> words{"run",
                                 command.look.string(),
                                 (folder / "in.####.exr").string(),
                                 "-o",
                                 (folder / "out.####.png").string(),
                                 "--frames",
                                 fmt::format("1-{}", command.frames)};
  if (!command.step.empty()) words.insert(words.end(), {"--report", (folder / "report.json").string()});
  return words;
}

/// Seconds that the report says of a step of the first frame.
Result<double> step_of_report(const std::filesystem::path& file, const std::string& step) {
  AFTERGLOW_TRY(const std::string text, read_file(file));
  const auto report = nlohmann::json::parse(text, nullptr, false);
  const nlohmann::json::json_pointer place("/frames/0/milliseconds");
  const bool there = report.is_object() && report.contains(place) && report.at(place).is_object() &&
                     report.at(place).contains(step) && report.at(place).at(step).is_number();
  if (!there) return Error{ErrorKind::usage, fmt::format("reports have no step '{}'", step)};
  return report.at(place).at(step).get<double>() / 1000;
}

Result<double> measure_command(const Goal& goal, const GoalTools& tools, Diagnostics& diagnostics, const Step& step) {
  const GoalCommand& command = *goal.command;
  if (!command.check) AFTERGLOW_CHECK(write_frames(goal, tools, diagnostics));
  const std::vector<std::string> words = words_of(command, tools.folder);
  std::vector<double> samples;
  for (int round = 0; round <= goal.repeat; ++round) {
    AFTERGLOW_CHECK(step(fmt::format("{}: round {} of {}", goal.name, round, goal.repeat)));
    std::map<std::string, std::string> environment;
    if (command.cold) {
      for (const char* name : {"AFTERGLOW_CACHE", "MESA_SHADER_CACHE_DIR"})
        environment[name] = (tools.folder / fmt::format("{}.{}", name, round)).string();
    }
    AFTERGLOW_TRY(double seconds, time_command(tools.program, words, environment));
    if (!command.step.empty()) {
      AFTERGLOW_TRY(seconds, step_of_report(tools.folder / "report.json", command.step));
    }
    if (round > 0) samples.push_back(seconds);
  }
  return Spread::of(std::move(samples)).median;
}

}  // namespace

Result<GoalResult> measure_goal(Device& device, const StackOptions& base, const Goal& goal, const GoalTools& tools,
                                Diagnostics& diagnostics, const Step& step) {
  GoalResult out{.name = goal.name,
                 .size = fmt::format("{}×{}", goal.size.width, goal.size.height),
                 .ratio = {},
                 .goal = goal.goal,
                 .next = goal.next,
                 .at_least = goal.at_least,
                 .unit = goal.command ? "s" : "",
                 .note = {}};
  auto measured = goal.command ? measure_command(goal, tools, diagnostics, step)
                               : measure_ratio(device, base, goal, diagnostics, step);
  if (measured) {
    out.ratio = *measured;
    return out;
  }
  const ErrorKind kind = measured.error().kind;
  if (kind == ErrorKind::device || kind == ErrorKind::interrupted) return std::move(measured).error();
  out.note = measured.error().text();
  return out;
}

Result<void> measure_goals(Device& device, const StackOptions& base, const std::vector<Goal>& goals, Report& report,
                           Diagnostics& diagnostics, const Step& step) {
  namespace fs = std::filesystem;
  std::error_code problem;
  const fs::path folder = fs::temp_directory_path(problem) / fmt::format("afterglow-bench-{}", getpid());
  const GoalTools tools{fs::read_symlink("/proc/self/exe", problem), folder};
  for (const auto& goal : goals) {
    fs::create_directories(folder, problem);
    auto result = measure_goal(device, base, goal, tools, diagnostics, step);
    fs::remove_all(folder, problem);
    if (!result) return std::move(result).error();
    report.goals.push_back(std::move(result).value());
  }
  return {};
}

}  // namespace afterglow::bench
