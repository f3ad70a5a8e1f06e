// SPDX-License-Identifier: MIT
#include "apps/farm_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>

#include "core/exception.h"
#include "core/text.h"
#include "farm/look.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

constexpr std::array kWords{"status", "report", "cancel", "retry", "chunk", "join"};
/// What the words take besides their job and what is for messages.
const std::map<std::string, std::vector<std::string>> kOfWords{
    {"status", {"--all", "--wait", "--report"}},
    {"report", {"--report"}},
    {"cancel", {}},
    {"retry", {"--partition", "--time", "--mem", "--retries", "--wait", "--report"}},
    {"chunk", {}},
    {"join", {}}};
constexpr std::array kOfMessages{"--help", "--verbose", "--quiet", "--no-color"};
/// Of `run`, what chunks decide themselves, and what is for streams.
constexpr std::array kNotForFarms{"--resume", "--watch", "--fail-fast", "--sandbox",
                                  "--lock",   "--stats", "--report",    "--raw"};
/// Named files of the look, which are packed.
constexpr std::array kPacked{"--path", "--calibration", "--locked", "--set"};

std::string long_name(const CLI::Option& option) {
  const auto names = option.get_lnames();
  return names.empty() ? std::string() : "--" + names.front();
}

bool is_one_of(const std::string& name, const auto& names) {
  return std::ranges::any_of(names, [&](const char* one) { return name == one; });
}

/// "grade.file=/tables/film.cube" with the packed file where the value names one.
std::string packed_override(const std::string& text, const fs::path& folder) {
  const std::size_t at = text.find('=');
  std::error_code ec;
  if (at == std::string::npos || !fs::is_regular_file(text.substr(at + 1), ec)) return text;
  const fs::path packed = farm::packed_place(folder, text.substr(at + 1));
  return fs::is_regular_file(packed, ec) ? text.substr(0, at + 1) + packed.string() : text;
}

std::vector<std::string> environment_paths() {
  const char* list = std::getenv("AFTERGLOW_PATH");
  std::vector<std::string> out = split(list ? list : "", ':');
  std::erase(out, "");
  return out;
}

}  // namespace

void FarmArguments::add(CLI::App& command) {
  app = &command;
  run.add(command);
  for (const char* name : kNotForFarms) command.remove_option(command.get_option(name));
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = long_name(*option);
    if (!name.empty() && name != "--help" && name != "--frames" && !is_one_of(name, kPacked))
      run_options.push_back(option);
  }
  command.get_option("PRESET")->description(
      fmt::format("Look to apply, as for `run`; or one of the words {}", fmt::join(kWords, ", ")));
  command.get_option("INPUT")->required(false)->description(
      "Pictures, as for `run`; behind a word the job: its folder, or that of its outputs");
  command.get_option("--output")
      ->required(false)
      ->description(
          "File, pattern (out.####.png), folder (NAME/ is made if need be) or video (mp4, mov, mkv, webm); the "
          "extension says the format");
  command.get_option("--format")->description("For outputs in a folder: png, exr, … (default: that of the input)");

  const std::string group = "Farm";
  command
      .add_option("--chunk", chunk,
                  "Frames a task makes (default: 24, or four times those that effects look back, if that is more)")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N")
      ->group(group);
  command.add_option("--partition", needs.partition, "Partition of the cluster")->type_name("NAME")->group(group);
  command.add_option("--time", needs.time, "Time limit of a task, as sbatch takes it: 30, 2:00:00")
      ->type_name("TIME")
      ->group(group);
  command.add_option("--mem", needs.memory, "Memory of a task, as sbatch takes it: 8G")
      ->type_name("SIZE")
      ->group(group);
  command
      .add_option("--retries", needs.retries,
                  "How often a task that failed or whose node died begins again (default 3)")
      ->check(CLI::Range(0, 1000))
      ->type_name("N")
      ->group(group);
  command.add_flag("--wait", wait, "Wait for all chunks; the exit code is that of the whole")->group(group);
  command.add_flag("--dry-run", dry_run, "Print the script and how it would be submitted; write nothing")->group(group);
  command
      .add_option("--jobs", jobs,
                  "Submit nothing: write the chunks with their commands, needs and outputs, for other schedulers")
      ->type_name("FILE.json")
      ->group(group);
  command.add_flag("--all", all, "status: every chunk, also those that are done")->group("Messages");
  command.add_option("--report", run.report, "Write the report of all chunks as JSON")
      ->type_name("FILE.json")
      ->group("Messages");
}

std::vector<std::string> farm_words() { return {kWords.begin(), kWords.end()}; }

std::string FarmArguments::word() const { return is_one_of(run.preset.file, kWords) ? run.preset.file : std::string(); }

Result<void> FarmArguments::check_options_of(const std::string& asked) const {
  const auto& taken = kOfWords.at(asked);
  const std::string allowed = taken.empty() ? "its job alone" : join(taken);
  const auto refused = [&](const std::string& what) {
    return Error{ErrorKind::usage, fmt::format("{} cannot go with '{}'", what, asked), "afterglow farm", 0, allowed};
  };
  for (const CLI::Option* option : app->get_options()) {
    const std::string name = long_name(*option);
    if (option->count() == 0 || name.empty() || is_one_of(name, kOfMessages)) continue;
    if (std::ranges::find(taken, name) == taken.end()) return refused(name);
  }
  if (!needs.more.empty() && asked != "retry") return refused("words behind --");
  return {};
}

Result<void> FarmArguments::check_word() const {
  const std::string asked = word();
  if (!asked.empty()) {
    const std::size_t most = asked == "chunk" ? 2 : 1;
    if (run.files.inputs.size() > most)
      return Error{ErrorKind::usage, fmt::format("'{}' is for one job", asked), "afterglow farm"};
    return check_options_of(asked);
  }
  const std::vector<std::string> words = farm_words();
  const std::string nearest = nearest_name(run.preset.file, words);
  if (run.files.output.empty() && !nearest.empty())
    return Error{ErrorKind::usage, fmt::format("'{}' is no word of it", run.preset.file),
                 "afterglow farm", 0,
                 join(words),      nearest};
  if (run.files.inputs.empty()) return Error{ErrorKind::usage, "INPUT is required", "afterglow farm"};
  if (run.files.output.empty()) return Error{ErrorKind::usage, "--output is required", "afterglow farm"};
  for (const auto& word : needs.more)
    if (word.starts_with("-a") || word.starts_with("--ar"))
      return Error{ErrorKind::usage, fmt::format("'{}': the array is that of the chunks", word), "afterglow farm", 0,
                   "--chunk for other ones"};
  if (!jobs.empty() && (wait || dry_run))
    return Error{ErrorKind::usage, "--jobs submits nothing and cannot go with --wait or --dry-run", "afterglow farm"};
  return {};
}

std::vector<std::string> FarmArguments::packed_words(const fs::path& preset, const fs::path& folder) const {
  std::vector<std::string> words;
  for (const CLI::Option* option : run_options) {
    if (option->count() == 0) continue;
    const std::string name = long_name(*option);
    if (option->get_items_expected_max() == 0)
      words.push_back(name);
    else
      for (const auto& value : option->results()) words.push_back(name + "=" + value);
  }
  for (const auto& text : run.preset.overrides) words.push_back("--set=" + packed_override(text, folder));
  std::vector<std::string> paths = run.preset.paths;
  std::ranges::move(environment_paths(), std::back_inserter(paths));
  for (const auto& path : paths) words.push_back("--path=" + farm::packed_place(folder, path).string());
  const fs::path table = folder / "look" / "calibration.json";
  std::error_code ec;
  if (fs::exists(table, ec)) words.push_back("--calibration=" + table.string());
  words.push_back("--locked=" + (folder / "look" / "lock.json").string());
  words.emplace_back("--");
  words.push_back(farm::packed_place(folder, preset).string());
  return words;
}

Result<BatchRequest> request_of_words(std::vector<std::string> words) {
  RunArguments arguments;
  CLI::App app;
  arguments.add(app);
  app.get_option("INPUT")->required(false);
  app.get_option("--output")->required(false);
  try {
    std::ranges::reverse(words);
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    return Error{ErrorKind::usage, exception_text(error)};
  }
  return arguments.request();
}

}  // namespace afterglow
