// SPDX-License-Identifier: MIT
// A farm job: frames in chunks, with everything that their pixels depend on besides the pictures. It lies in a folder
// beside the outputs, `.afterglow-farm/ID/`, that all machines see, and nothing else is shared:
//
//   job.json    what this file describes; never changed
//   look/       the preset and all that it reads, the calibration, the lock
//   task.sh     what the scheduler runs
//   slurm.json  what was submitted
//   attempts/   what became of each chunk: see attempt.h
//   logs/       what each chunk had to say
//   pieces/     of a job whose output is one video: what the chunks made, until it is joined
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "batch/batch_run.h"
#include "core/result.h"

namespace afterglow::farm {

inline constexpr const char* kFolder = ".afterglow-farm";

/// Frames that one task of the scheduler makes.
struct Chunk {
  std::vector<std::string> inputs;
  std::string frames;  ///< as --frames takes them; empty: of inputs that are no sequences
  int count = 0;
};

/// What the scheduler is asked for.
struct Needs {
  std::string partition, time, memory;  ///< as sbatch takes them; empty: its defaults
  int retries = 3;                      ///< how often a task that failed begins again
  std::vector<std::string> more;        ///< words for sbatch as they are
};

struct Job {
  std::string id;
  std::filesystem::path folder;                    ///< absolute; not in job.json
  std::string program;                             ///< that runs the chunks, absolute
  std::string version;                             ///< of the program that made the job
  std::filesystem::path at;                        ///< the folder that inputs and outputs are named from
  std::string look;                                ///< as it was given
  std::vector<std::string> run;                    ///< words of `afterglow run`, but for the inputs and --frames
  std::map<std::string, std::string> environment;  ///< set for the chunks; empty values are removed
  std::map<std::string, std::string> files;        ///< hash by name in the folder
  std::optional<int> pre_roll;  ///< earlier frames that a chunk runs first; empty: no frame depends on others
  Needs needs;
  std::vector<Chunk> chunks;
  std::string video;           ///< the one output, absolute, joined from a piece a chunk; empty: pictures
  bool holds_missing = false;  ///< of the video: see hold_missing

  std::size_t frames() const;
  /// Chunks, and behind them the joining of a video.
  std::size_t tasks() const { return chunks.size() + (video.empty() ? 0 : 1); }
  bool is_join(std::size_t task) const { return task == chunks.size() && !video.empty(); }
  /// The words that make one chunk, or join the video.
  std::vector<std::string> command(std::size_t task) const;
  /// Where chunks leave their parts of the video, until it is joined.
  std::filesystem::path pieces() const { return folder / "pieces"; }
  /// Where a chunk leaves its part of the video.
  std::filesystem::path piece(std::size_t chunk) const;
  /// All frames as `run` takes them: inputs that follow each other and their frames, as few as can be.
  std::vector<Chunk> inputs() const;
};

/// Chunks of at most so many frames, by sequence or video, in the order of `jobs`, which list_frames made.
std::vector<Chunk> chunks_of(const std::vector<FrameJob>& jobs, int most);

/// A folder for a new job beside the outputs. Errors: io.
Result<std::filesystem::path> make_job_folder(const std::filesystem::path& outputs);
/// What the ID of a job made now would be.
std::string new_job_id();

/// Errors: usage (a name that is no UTF-8), io.
Result<void> write_job(const Job& job);
/// Errors: io (no job, one of a later version).
Result<Job> read_job(const std::filesystem::path& folder);
/// The folders of all jobs beside these outputs, the latest at the end.
std::vector<std::filesystem::path> job_folders(const std::filesystem::path& outputs);
/// The job that is meant: its folder, its ID with the outputs in this folder, or a folder of outputs, whose latest job
/// it is. Errors: io.
Result<Job> find_job(const std::string& given);
/// The job for schedulers that Afterglow does not speak to: its chunks with their commands, needs and outputs, as JSON.
/// `frames` are those of the job, in the order of the chunks. Errors: usage (a name that is no UTF-8).
Result<std::string> jobs_text(const Job& job, const FrameListRequest& request, const std::vector<FrameJob>& frames);

/// Removes a job that nobody has begun.
void discard_job(const Job& job);
/// Are the packed files what they were, and the folder where it was? Its words and the names of outputs are of there.
/// Errors: io, naming the first that is not.
Result<void> check_packed(const Job& job);

}  // namespace afterglow::farm
