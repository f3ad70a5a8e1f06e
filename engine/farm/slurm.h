// SPDX-License-Identifier: MIT
// Slurm by its programs: sbatch, squeue, sacct, scontrol, scancel.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "farm/job.h"

namespace afterglow::farm {

/// A job array that was submitted. Task I of it makes chunk `base` + I.
struct SlurmArray {
  std::string id;
  std::string cluster;  ///< empty: the one that commands speak to anyway
  std::size_t base = 0;
};

/// What was submitted of a job, in that order; of a chunk the last one counts.
struct Submissions {
  std::vector<SlurmArray> arrays;
  bool cancelled = false;  ///< since the last of them
};
/// Nothing where there is none. Errors: io.
Result<Submissions> read_submissions(const Job& job);
Result<void> write_submissions(const Job& job, const Submissions& submissions);
/// Of a job that another scheduler has, `what` ("cancel it") is left to that one. Errors: io.
Result<void> check_submitted(const Job& job, const Submissions& submissions, const char* what);

/// The script of a task, for /bin/sh; its first argument is the chunk of task 0.
std::string task_script(const Job& job);
/// Writes it into the job's folder; arrays that were submitted keep theirs. Errors: io.
Result<void> write_task_script(const Job& job);

/// An array that is to be submitted: its first chunk, and tasks as sbatch's --array takes them.
struct ArrayPlan {
  std::size_t base = 0;
  std::string tasks;
  std::vector<std::string> after = {};  ///< arrays that end before it begins
};
/// `most` tasks an array, numbered from 0. `chunks` by number.
std::vector<ArrayPlan> array_plans(const std::vector<std::size_t>& chunks, std::size_t most);
/// The words that submit it.
std::vector<std::string> sbatch_words(const Job& job, const ArrayPlan& plan);

/// How the job would be submitted, and the script: what --dry-run prints. Asks Slurm how large arrays may be, where it
/// is there.
std::string plan_text(const Job& job);
/// The tasks of a job by number: its chunks, and the joining of a video.
std::vector<std::size_t> every_task(const Job& job);

/// How many tasks an array of the cluster may have. Errors: io (Slurm is not there, or does not answer).
Result<std::size_t> largest_array();
/// Submits the tasks, by rising number, and takes down each array as it is accepted. Where one is refused, those before
/// it are cancelled. The joining of a video waits for all chunks that Slurm has; one that waits already is taken back.
/// Errors: io.
Result<Submissions> submit(const Job& job, const std::vector<std::size_t>& tasks);
/// Ends what waits and runs. Errors: io.
Result<void> cancel(const Job& job);

/// What Slurm knows of a chunk.
struct TaskState {
  std::string state;      ///< in Slurm's words: PENDING, RUNNING, NODE_FAIL, …
  std::string node;       ///< empty: none yet
  std::string reason;     ///< why it waits
  std::size_t place = 0;  ///< of its array among those submitted
  bool ended() const;     ///< nothing more happens to it
};
/// Why a task ended without an end of its own, for people: of TIMEOUT, OUT_OF_MEMORY, NODE_FAIL, …
std::string why_it_ended(const std::string& state);
/// Of the chunks that Slurm still knows: its queue, and its accounting where there is one. Errors: io.
Result<std::map<std::size_t, TaskState>> task_states(const Submissions& submissions);

/// By chunk.
using TaskStates = std::map<std::size_t, TaskState>;
/// The same from what `squeue --format="%F|%K|%T|%N|%r"` and `sacct --format=JobID,State,NodeList` print of one
/// cluster.
TaskStates states_of_queue(const std::string& squeue, const Submissions& submissions, const std::string& cluster = "");
TaskStates states_of_accounting(const std::string& sacct, const Submissions& submissions,
                                const std::string& cluster = "");
/// Of a chunk that both know, the array that was submitted later counts; of the same array `states`.
void add_later(TaskStates& states, const TaskStates& more);
/// How many tasks an array may have, by what `scontrol show config` prints; none: it does not say.
std::optional<std::size_t> largest_array(const std::string& config);

}  // namespace afterglow::farm
