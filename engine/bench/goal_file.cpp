// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "bench/goals.h"
#include "core/file.h"

namespace afterglow::bench {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

Result<Size> read_size(const std::string& text) {
  Size size;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &size.width, &size.height, &rest) != 2 || size.width < 1 ||
      size.height < 1 || size.width > 16384 || size.height > 16384)
    return Error{ErrorKind::io, fmt::format("'{}' is no size", text)};
  return size;
}

Result<GoalTerm> read_term(const Json& json, const fs::path& folder) {
  GoalTerm term;
  term.times = json.value("times", 1.0);
  term.copy = json.value("copy", false);
  term.frame = json.value("frame", false);
  term.display = json.value("display", false);
  term.light = json.value("light", 1.0);
  if (json.contains("size")) {
    AFTERGLOW_TRY(term.size, read_size(json.at("size")));
  }
  if (term.copy) return term;
  term.look = folder / json.at("look").get<std::string>();
  if (json.contains("choice")) {
    AFTERGLOW_TRY(term.choice, parse_execution(json.at("choice")));
  }
  for (const auto& text : json.value("set", std::vector<std::string>{})) {
    AFTERGLOW_TRY(Override parsed, parse_override(text));
    term.overrides.push_back(std::move(parsed));
  }
  return term;
}

Result<std::vector<GoalTerm>> read_sum(const Json& json, const fs::path& folder) {
  std::vector<GoalTerm> out;
  for (const auto& one : json) {
    AFTERGLOW_TRY(GoalTerm term, read_term(one, folder));
    out.push_back(std::move(term));
  }
  return out;
}

Result<Goal> read_goal(const Json& json, const fs::path& folder) {
  Goal goal;
  goal.at_least = json.contains("at_least");
  goal.goal = json.at(goal.at_least ? "at_least" : "at_most").get<double>();
  if (json.contains("next")) goal.next = json.at("next").get<double>();
  goal.repeat = json.value("repeat", 9);
  if (goal.repeat < 1) return Error{ErrorKind::usage, fmt::format("\"repeat\" is {}; it is 1 at least", goal.repeat)};
  if (json.contains("command")) {
    const Json& command = json.at("command");
    goal.command = GoalCommand{.look = folder / command.at("look").get<std::string>(),
                               .frames = command.value("frames", 1),
                               .cold = command.value("cold", false),
                               .check = command.value("check", false),
                               .step = command.value("step", "")};
    return goal;
  }
  AFTERGLOW_TRY(goal.over, read_sum(json.at("over"), folder));
  AFTERGLOW_TRY(goal.under, read_sum(json.at("under"), folder));
  return goal;
}

Result<void> read_all(const Json& root, const fs::path& folder, std::vector<Goal>& goals, std::string& name) {
  for (const auto& json : root.at("goals")) {
    name = json.at("name").get<std::string>();
    AFTERGLOW_TRY(Goal goal, read_goal(json, folder));
    goal.name = name;
    for (const auto& size : json.at("sizes")) {
      AFTERGLOW_TRY(goal.size, read_size(size));
      goals.push_back(goal);
    }
  }
  return {};
}

}  // namespace

Result<std::vector<Goal>> load_goals(const fs::path& file) {
  AFTERGLOW_TRY(const std::string text, read_named_file(file));
  std::vector<Goal> goals;
  std::string name;
  Result<void> done;
  try {
    done = read_all(Json::parse(text), file.parent_path(), goals, name);
  } catch (const Json::exception& problem) {
    done = Error{ErrorKind::io, problem.what()};
  }
  if (done) return goals;
  Error error = std::move(done).error();
  error.kind = ErrorKind::io;
  error.file = file.string();
  if (!name.empty()) error.message = fmt::format("goal '{}': {}", name, error.message);
  return error;
}

}  // namespace afterglow::bench
