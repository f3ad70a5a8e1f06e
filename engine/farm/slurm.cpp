// SPDX-License-Identifier: MIT
#include "farm/slurm.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <set>
#include <string_view>

#include "core/ascii.h"
#include "core/file.h"
#include "core/file_lock.h"
#include "core/json_text.h"
#include "core/parse_number.h"
#include "core/printable.h"
#include "core/process.h"
#include "core/text.h"

namespace afterglow::farm {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSlurmVersion = 1;

/// The last line of what a program said, for messages.
std::string last_words(const ProcessEnd& end) {
  const std::string said = trim(end.err.empty() ? end.out : end.err);
  return said.substr(said.rfind('\n') + 1);
}

/// Runs a program of Slurm's that is to succeed; what it prints.
Result<std::string> output_of(const std::vector<std::string>& words) {
  auto ended = run_process(words);
  constexpr const char* kWhere =
      "a machine that can submit to Slurm (Debian: slurm-client), or --jobs FILE.json for other schedulers";
  if (!ended) {
    Error error = std::move(ended).error();
    error.allowed = kWhere;
    return error;
  }
  if (ended->code != 0) {
    Error error{ErrorKind::io,
                fmt::format("{} ended with code {}: {}", words.front(), ended->code, last_words(*ended))};
    // Its programs are there, and know of no cluster.
    if (error.message.find("configuration source") != std::string::npos) error.allowed = kWhere;
    return error;
  }
  return ended->out;
}

/// Words that are for one cluster, where there are several.
void add_cluster(std::vector<std::string>& words, const std::string& cluster) {
  if (!cluster.empty()) words.push_back("--clusters=" + cluster);
}

/// Position of an array among those submitted; none: it is not of this job. Clusters count for themselves.
std::optional<std::size_t> place_of(const Submissions& submissions, const std::string& id, const std::string& cluster) {
  for (std::size_t i = 0; i < submissions.arrays.size(); ++i)
    if (submissions.arrays[i].id == id && submissions.arrays[i].cluster == cluster) return i;
  return std::nullopt;
}

/// What one cluster says of tasks, of which the array that was submitted last counts.
class Latest {
 public:
  Latest(const Submissions& submissions, const std::string& cluster) : submissions_(submissions), cluster_(cluster) {}
  void add(const std::string& array, std::string_view task, TaskState state) {
    const auto place = place_of(submissions_, array, cluster_);
    const auto index = parse_number<std::size_t>(task);
    if (!place || !index) return;
    const auto [at, fresh] = states_.try_emplace(submissions_.arrays[*place].base + *index);
    if (!fresh && at->second.place > *place) return;
    state.place = *place;
    at->second = std::move(state);
  }
  TaskStates take() { return std::move(states_); }

 private:
  const Submissions& submissions_;
  const std::string& cluster_;
  TaskStates states_;
};

/// "12_3" as array and task.
std::pair<std::string, std::string> parts_of(const std::string& job_id) {
  const std::size_t at = job_id.find('_');
  return at == std::string::npos ? std::pair(job_id, std::string())
                                 : std::pair(job_id.substr(0, at), job_id.substr(at + 1));
}

std::vector<std::string> lines_of(const std::string& text) {
  auto lines = split(text, '\n');
  std::erase(lines, "");
  return lines;
}

/// Of what `sbatch --parsable` printed: "24" or "24;cluster", behind what wrappers and plug-ins of a site say.
Result<SlurmArray> array_of(const std::string& printed, std::size_t base) {
  const auto lines = lines_of(trim(printed));
  const auto parts = split(lines.empty() ? "" : trim(lines.back()), ';');
  const bool number = !parts.empty() && !parts[0].empty() && std::ranges::all_of(parts[0], is_digit);
  if (number) return SlurmArray{parts[0], parts.size() > 1 ? parts[1] : "", base};
  return Error{ErrorKind::io, fmt::format("sbatch told no number of a job: '{}'", tidy_message(trim(printed), 200))};
}

/// Of arrays of one cluster, by comma.
std::map<std::string, std::string> ids_by_cluster(const Submissions& submissions) {
  std::map<std::string, std::string> out;
  for (const auto& array : submissions.arrays) {
    auto& ids = out[array.cluster];
    ids += (ids.empty() ? "" : ",") + array.id;
  }
  return out;
}

/// Arrays of the tasks; a video is joined by one of its own.
std::vector<ArrayPlan> task_plans(const Job& job, std::vector<std::size_t> tasks, std::size_t most) {
  const bool joins = !tasks.empty() && job.is_join(tasks.back());
  if (joins) tasks.pop_back();
  auto plans = array_plans(tasks, most);
  if (joins) plans.push_back(array_plans({job.chunks.size()}, most).front());
  return plans;
}

/// Whether the array is the joining of the video.
bool is_join(const Job& job, const ArrayPlan& plan) {
  const auto task = parse_number<std::size_t>(plan.tasks);
  return task && job.is_join(plan.base + *task);
}

std::vector<std::string> cancel_words(const SlurmArray& array) {
  std::vector<std::string> words{"scancel", "--quiet", array.id};
  add_cluster(words, array.cluster);
  return words;
}

/// Arrays with chunks that wait or run. A join that waits for them already is taken back.
Result<std::vector<std::string>> arrays_before_the_join(const Job& job, const Submissions& all) {
  std::set<std::string> live;
  AFTERGLOW_TRY(const auto states, task_states(all));
  for (const auto& [task, state] : states) {
    if (state.ended()) continue;
    const SlurmArray& array = all.arrays[state.place];
    if (!job.is_join(task)) {
      live.insert(array.id);
      continue;
    }
    static_cast<void>(run_process(cancel_words(array)));
  }
  return std::vector<std::string>(live.begin(), live.end());
}

}  // namespace

std::string why_it_ended(const std::string& state) {
  static const std::map<std::string_view, std::string_view> kReasons{
      {"TIMEOUT", "its time limit was over; `farm retry` with a longer --time goes on"},
      {"OUT_OF_MEMORY", "it needed more memory than it had; `farm retry` with a larger --mem goes on"},
      {"NODE_FAIL", "its node went down"},
      {"BOOT_FAIL", "its node did not start"},
      {"PREEMPTED", "another job took its place"},
      {"DEADLINE", "its deadline was over"}};
  const auto found = kReasons.find(state);
  return found != kReasons.end() ? std::string(found->second) : fmt::format("Slurm: {}", lower(state));
}

bool TaskState::ended() const {
  constexpr std::array kEnds{"COMPLETED",     "FAILED",    "CANCELLED", "TIMEOUT", "NODE_FAIL",     "DEADLINE",
                             "OUT_OF_MEMORY", "BOOT_FAIL", "PREEMPTED", "REVOKED", "LAUNCH_FAILED", "RECONFIG_FAIL"};
  return std::ranges::any_of(kEnds, [&](const char* end) { return state == end; });
}

Result<Submissions> read_submissions(const Job& job) {
  const auto file = job.folder / "slurm.json";
  if (!is_file(file)) return Submissions{};
  AFTERGLOW_TRY(const std::string text, read_file(file));
  try {
    const Json json = Json::parse(text);
    Submissions out;
    out.cancelled = json.at("cancelled").get<bool>();
    for (const auto& one : json.at("arrays"))
      out.arrays.push_back(
          {one.at("id").get<std::string>(), one.at("cluster").get<std::string>(), one.at("base").get<std::size_t>()});
    return out;
  } catch (const nlohmann::json::exception& error) {
    return Error{ErrorKind::io, fmt::format("is no list of submissions: {}", error.what()), file.string()};
  }
}

/// Of those who change the list of submissions: two at once would lose arrays, which nobody could cancel then.
std::filesystem::path lock_of(const Job& job) { return job.folder / "slurm.lock"; }

Result<void> write_submissions(const Job& job, const Submissions& submissions) {
  Json json{{"afterglow_slurm", kSlurmVersion}, {"cancelled", submissions.cancelled}, {"arrays", Json::array()}};
  for (const auto& array : submissions.arrays)
    json["arrays"].push_back(Json{{"id", array.id}, {"cluster", array.cluster}, {"base", array.base}});
  return write_file_atomically(job.folder / "slurm.json", json_text(json));
}

std::string task_script(const Job& job) {
  return fmt::format(R"(#!/bin/sh
# Made by `afterglow farm`. A task of the array makes one chunk of frames; that of task 0 is the first argument.
job={}
chunk=$(($1 + SLURM_ARRAY_TASK_ID))
# Without a log the chunk is made all the same: `command` keeps the shell from ending here.
command exec >>"$job/logs/$chunk.log" 2>&1
{} farm chunk "$job" "$chunk"
code=$?
# Behind the last chunk a video is joined, once all are done: trying again brings none of them back.
[ "$chunk" -lt {} ] || exit $code
# What no other try mends: a look or options that are wrong. What was told to stop: 130, 143.
case $code in 0 | 2 | 3 | 130 | 143) exit $code ;; esac
if [ "${{SLURM_RESTART_COUNT:-0}}" -lt {} ]; then
  echo "exit code $code on ${{SLURMD_NODENAME:-this machine}}; once more, for what is missing"
  scontrol requeue "$SLURM_JOB_ID"
fi
exit $code
)",
                     shell_word(job.folder.string()), shell_word(job.program), job.chunks.size(), job.needs.retries);
}

Result<void> write_task_script(const Job& job) {
  return write_file_atomically(job.folder / "task.sh", task_script(job));
}

std::vector<ArrayPlan> array_plans(const std::vector<std::size_t>& chunks, std::size_t most) {
  std::vector<ArrayPlan> plans;
  for (std::size_t i = 0; i < chunks.size();) {
    const std::size_t base = chunks[i] / most * most;
    std::vector<int> tasks;
    for (; i < chunks.size() && chunks[i] < base + most; ++i) tasks.push_back(static_cast<int>(chunks[i] - base));
    std::string text = frames_text(tasks);
    std::ranges::replace(text, 'x', ':');
    plans.push_back({base, std::move(text)});
  }
  return plans;
}

std::vector<std::string> sbatch_words(const Job& job, const ArrayPlan& plan) {
  std::vector<std::string> words{"sbatch",    "--parsable",         "--job-name=afterglow-" + job.id,
                                 "--requeue", "--output=/dev/null", "--chdir=" + job.at.string()};
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) words.push_back(option + value);
  };
  add("--partition=", job.needs.partition);
  add("--time=", job.needs.time);
  add("--mem=", job.needs.memory);
  words.insert(words.end(), job.needs.more.begin(), job.needs.more.end());
  // Last, so that they count: what the job's own words wait for, the chunks have waited for.
  words.push_back("--array=" + plan.tasks);
  if (!plan.after.empty()) words.push_back("--dependency=afterany:" + join(plan.after, ":"));
  words.push_back((job.folder / "task.sh").string());
  words.push_back(fmt::format("{}", plan.base));
  return words;
}

std::vector<std::size_t> every_task(const Job& job) {
  std::vector<std::size_t> out(job.tasks());
  std::iota(out.begin(), out.end(), 0);
  return out;
}

std::string plan_text(const Job& job) {
  const auto most = largest_array();
  std::string out = fmt::format("# {} frames in {} chunks{}{}\n", job.frames(), job.chunks.size(),
                                job.pre_roll ? fmt::format(", each behind {} frames of pre-roll", *job.pre_roll) : "",
                                job.video.empty() ? "" : ", then joined");
  for (const auto& plan : task_plans(job, every_task(job), most ? *most : job.tasks())) {
    ArrayPlan shown = plan;
    if (is_join(job, plan)) shown.after = {"ARRAYS_ABOVE"};
    out += shell_line(sbatch_words(job, shown)) + "\n";
  }
  return out + fmt::format("\n# {}\n{}", (job.folder / "task.sh").string(), task_script(job));
}

std::optional<std::size_t> largest_array(const std::string& config) {
  constexpr std::string_view kLimit = "max_array_tasks=";  // one of SchedulerParameters, below MaxArraySize
  std::optional<std::size_t> largest;
  const auto hold = [&](std::string_view number) {
    if (const auto size = parse_number<std::size_t>(trim(std::string(number))); size && *size > 0)
      largest = std::min(largest.value_or(*size), *size);
  };
  for (const auto& line : lines_of(config)) {
    const std::size_t at = line.find('=');
    const std::string name = trim(line.substr(0, at)), value = at == std::string::npos ? "" : trim(line.substr(at + 1));
    if (name == "MaxArraySize") hold(value);
    if (name != "SchedulerParameters") continue;
    for (const std::string& parameter : split(value, ','))
      if (parameter.starts_with(kLimit)) hold(std::string_view(parameter).substr(kLimit.size()));
  }
  return largest;
}

Result<std::size_t> largest_array() {
  AFTERGLOW_TRY(const std::string config, output_of({"scontrol", "show", "config"}));
  if (const auto largest = largest_array(config)) return *largest;
  return Error{ErrorKind::io, "scontrol does not say MaxArraySize; are job arrays switched off?"};
}

Result<Submissions> submit(const Job& job, const std::vector<std::size_t>& tasks) {
  AFTERGLOW_TRY(const std::size_t most, largest_array());
  const FileLock lock(lock_of(job));
  AFTERGLOW_TRY(Submissions all, read_submissions(job));
  const std::size_t before = all.arrays.size();
  std::vector<std::string> live;  // arrays that the joining waits for
  if (before > 0 && job.is_join(tasks.back())) {
    AFTERGLOW_TRY(live, arrays_before_the_join(job, all));
  }
  all.cancelled = false;
  for (auto& plan : task_plans(job, tasks, most)) {
    if (is_join(job, plan)) plan.after = live;
    auto printed = output_of(sbatch_words(job, plan));
    auto array = printed ? array_of(*printed, plan.base) : Result<SlurmArray>(std::move(printed).error());
    Result<void> noted;
    if (array) {
      live.push_back(array->id);
      all.arrays.push_back(*array);
      noted = write_submissions(job, all);
    }
    if (array && noted) continue;
    for (std::size_t i = before; i < all.arrays.size(); ++i)
      static_cast<void>(run_process(cancel_words(all.arrays[i])));
    return array ? std::move(noted).error() : std::move(array).error();
  }
  return all;
}

Result<void> check_submitted(const Job& job, const Submissions& submissions, const char* what) {
  if (!submissions.arrays.empty()) return {};
  return Error{ErrorKind::io, fmt::format("was not submitted to Slurm; {} where it was", what), job.folder.string()};
}

Result<void> cancel(const Job& job) {
  const FileLock lock(lock_of(job));  // what is being submitted is submitted first, and known
  AFTERGLOW_TRY(Submissions all, read_submissions(job));
  AFTERGLOW_CHECK(check_submitted(job, all, "cancel it"));
  all.cancelled = true;
  AFTERGLOW_CHECK(write_submissions(job, all));
  Result<void> first;  // that went wrong; the others are cancelled all the same
  for (const auto& array : all.arrays) {
    const auto ended = run_process(cancel_words(array));
    if (!ended) return ended.error();
    // An array that Slurm has forgotten has ended.
    if (ended->code != 0 && ended->err.find("Invalid job id") == std::string::npos && first)
      first = Error{ErrorKind::io, fmt::format("scancel of {} ended with code {}: {}; cancel again", array.id,
                                               ended->code, last_words(*ended))};
  }
  return first;
}

TaskStates states_of_queue(const std::string& squeue, const Submissions& submissions, const std::string& cluster) {
  Latest states(submissions, cluster);
  for (const auto& line : lines_of(squeue)) {
    const auto parts = split(line, '|');
    if (parts.size() >= 5) states.add(parts[0], parts[1], {parts[2], parts[3], parts[4] == "None" ? "" : parts[4]});
  }
  return states.take();
}

TaskStates states_of_accounting(const std::string& sacct, const Submissions& submissions, const std::string& cluster) {
  Latest states(submissions, cluster);
  for (const auto& line : lines_of(sacct)) {
    const auto parts = split(line, '|');
    if (parts.size() < 3) continue;
    const auto [array, task] = parts_of(parts[0]);
    // "CANCELLED by 1000"
    states.add(array, task, {parts[1].substr(0, parts[1].find(' ')), parts[2] == "None assigned" ? "" : parts[2], ""});
  }
  return states.take();
}

void add_later(TaskStates& states, const TaskStates& more) {
  for (const auto& [chunk, state] : more) {
    const auto [at, fresh] = states.emplace(chunk, state);
    if (!fresh && at->second.place < state.place) at->second = state;
  }
}

Result<TaskStates> task_states(const Submissions& submissions) {
  TaskStates states;
  for (const auto& [cluster, ids] : ids_by_cluster(submissions)) {
    std::vector<std::string> words{"squeue", "--noheader", "--array", "--states=all", "--format=%F|%K|%T|%N|%r"};
    // A single array that Slurm has forgotten is an error, a list of them is not.
    words.push_back("--jobs=" + ids + "," + ids);
    add_cluster(words, cluster);
    AFTERGLOW_TRY(const std::string text, output_of(words));
    add_later(states, states_of_queue(text, submissions, cluster));
    std::vector<std::string> asked{
        "sacct", "--noheader", "--parsable2", "--allocations", "--format=JobID,State,NodeList", "--jobs=" + ids};
    add_cluster(asked, cluster);
    const auto accounted = run_process(asked);
    if (accounted && accounted->code == 0)
      add_later(states, states_of_accounting(accounted->out, submissions, cluster));
  }
  return states;
}

}  // namespace afterglow::farm
