// SPDX-License-Identifier: MIT
// Ratios that the project wants to reach, described as data and measured.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/cell.h"
#include "bench/results.h"

namespace afterglow::bench {

/// One time in a sum: `times` · the median of what it describes.
struct GoalTerm {
  double times = 1;
  bool copy = false;           ///< one RGBA32F copy pass of the picture
  std::filesystem::path look;  ///< else: a preset
  std::vector<Override> overrides;
  std::optional<ExecutionConfig> choice;  ///< empty: as `run` would choose
  bool display = false;                   ///< the last kernel writes 8-bit display codes
  bool frame = false;                     ///< a whole frame as `run` makes it, not only what was recorded
  double light = 1;                       ///< factor of the picture
  std::optional<Size> size;               ///< another than the goal's
};

/// A whole command: reading, executing, writing.
struct GoalCommand {
  std::filesystem::path look;
  int frames = 1;
  bool cold = false;   ///< with empty caches
  bool check = false;  ///< `check` instead of `run`
  std::string step{};  ///< of its first frame alone, as --report names it: "execute"; empty: the whole
};

struct Goal {
  std::string name;
  Size size;
  std::vector<GoalTerm> over, under;   ///< the ratio of their sums
  std::optional<GoalCommand> command;  ///< instead of both: seconds
  double goal = 0;
  std::optional<double> next;
  bool at_least = false;
  int repeat = 9;
};

/// Reads a file of goals (docs/benchmarks/goals.json is one); looks are relative to it. A goal with several sizes
/// becomes several. Errors (io): no such file, no such goals; they name the goal.
Result<std::vector<Goal>> load_goals(const std::filesystem::path& file);

/// What commands need: this program and a folder for pictures and caches.
struct GoalTools {
  std::filesystem::path program, folder;
};

/// Measures one. A goal that fails because of a look, or because memory does not suffice, is a result with a note;
/// errors of the device and of `step` end the work.
Result<GoalResult> measure_goal(Device& device, const StackOptions& base, const Goal& goal, const GoalTools& tools,
                                Diagnostics& diagnostics, const Step& step);

/// Adds the result of each goal to the report; commands are run with this program, in a folder that is gone afterwards.
/// Errors: those of `measure_goal`.
Result<void> measure_goals(Device& device, const StackOptions& base, const std::vector<Goal>& goals, Report& report,
                           Diagnostics& diagnostics, const Step& step);

}  // namespace afterglow::bench
