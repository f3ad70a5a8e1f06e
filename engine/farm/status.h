// SPDX-License-Identifier: MIT
// How far a job is, and what came of it: what Slurm says and what the chunks have left, put together.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "farm/job.h"

namespace afterglow::farm {

struct ChunkStatus {
  enum class State {
    not_begun,  ///< and nobody is to begin it
    waiting,    ///< in the scheduler's queue
    running,
    ending,  ///< Slurm says that it succeeded; its report is on its way through the file system
    done,
    failed,  ///< it ended with an exit code
    lost,    ///< it was killed, or its node died
    cancelled,
  };
  State state = State::not_begun;
  int tries = 0;
  std::optional<int> exit_code;  ///< of the last try that ended
  bool was_done = false;         ///< by one of the tries
  std::string node, why;
};

struct JobStatus {
  std::vector<ChunkStatus> chunks;  ///< and behind them the joining of a video
  std::vector<std::string> arrays;  ///< their ids
  std::size_t frames = 0, frames_done = 0;
  std::size_t count(ChunkStatus::State state) const;
  /// Is anything still to come?
  bool live() const;
  bool done() const { return count(ChunkStatus::State::done) == chunks.size(); }
};

/// Asks Slurm where the job was submitted to it. Errors: io.
Result<JobStatus> status_of(const Job& job);
/// Chunks that are neither done nor in the queue; with any of them, or by itself, the joining of a video that is not
/// done and does not run.
std::vector<std::size_t> tasks_to_retry(const Job& job, const JobStatus& status);

/// Counts, and a line for each chunk that is not as it should be; with `all` for every one.
std::string status_text(const Job& job, const JobStatus& status, bool all);
/// "6 done, 2 running on n1 n2, 1 failed".
std::string status_line(const JobStatus& status);
/// What stands behind a count of frames while they are made: "frames; of 9 chunks 6 done, 2 running, 1 waiting (n1 n2);
/// the join is waiting".
std::string waiting_line(const Job& job, const JobStatus& status);
/// What a program that waited for the job ends with: nothing when all is done, else an error that says how much is not.
Result<void> outcome_of(const Job& job, const JobStatus& status);

/// The reports of all chunks as one: of every frame what its last try says, with the times of the try that made it;
/// sums by node and device.
struct MergedReport {
  std::string text;  ///< for people
  std::string json;
};
/// Errors: io. A report that cannot be read is left out and said so.
Result<MergedReport> merged_report(const Job& job, const JobStatus& status);

}  // namespace afterglow::farm
