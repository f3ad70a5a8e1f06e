// SPDX-License-Identifier: MIT
#include "farm/status.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "core/file.h"
#include "core/table.h"
#include "core/text.h"
#include "farm/attempt.h"
#include "farm/slurm.h"

namespace afterglow::farm {
namespace {

using State = ChunkStatus::State;
using Json = nlohmann::ordered_json;

constexpr std::array kWords{"not begun", "waiting", "running", "ending", "done", "failed", "lost", "cancelled"};
constexpr int kInterruptedCode = static_cast<int>(ErrorKind::interrupted);

const char* word_of(State state) { return kWords.at(static_cast<std::size_t>(state)); }

/// What the files of its tries say of a chunk, before anyone is asked.
void take_attempt(ChunkStatus& chunk, const AttemptFile& attempt) {
  ++chunk.tries;
  if (!attempt.exit_code) {
    chunk.state = State::lost;
    chunk.why = "it began and did not end";
    return;
  }
  chunk.exit_code = attempt.exit_code;
  chunk.state = *attempt.exit_code == 0                  ? State::done
                : *attempt.exit_code == kInterruptedCode ? State::lost
                                                         : State::failed;
  chunk.was_done |= chunk.state == State::done;
  chunk.why = *attempt.exit_code == kInterruptedCode ? "it was told to stop" : "";
}

/// What is done stays so behind a try that was killed or told to stop, not behind one that failed.
void take_attempts(JobStatus& status, const std::vector<AttemptFile>& attempts) {
  for (const auto& attempt : attempts) {
    ChunkStatus& chunk = status.chunks[attempt.chunk];
    if (chunk.state == State::done && attempt.exit_code.value_or(kInterruptedCode) == kInterruptedCode)
      ++chunk.tries;
    else
      take_attempt(chunk, attempt);
  }
}

/// The pieces of a video go when they are joined: where it is gone too, they and the join are to be made again. Says
/// whether that is so.
bool take_lost_video(const Job& job, JobStatus& status) {
  if (job.video.empty() || status.chunks.back().state != State::done || is_file(job.video)) return false;
  for (std::size_t i = 0; i < status.chunks.size(); ++i) {
    ChunkStatus& chunk = status.chunks[i];
    if (chunk.state != State::done || (!job.is_join(i) && is_file(job.piece(i)))) continue;
    chunk.state = State::lost;
    chunk.why = "the video that was joined is gone";
  }
  return true;
}

/// The same chunk as Slurm sees it.
void take_task(ChunkStatus& chunk, const TaskState& task, bool cancelled) {
  chunk.node = task.node;
  if (chunk.state == State::done) return;
  if (!task.ended()) {
    const bool waits = task.state == "PENDING" || task.state == "REQUEUED" || task.state == "SPECIAL_EXIT" ||
                       task.state == "REQUEUE_HOLD" || task.state == "REQUEUE_FED";
    chunk.state = waits ? State::waiting : State::running;
    chunk.why = waits ? lower(task.reason) : "";
    return;
  }
  if (task.state == "COMPLETED") {
    if (!chunk.was_done) chunk.state = State::ending;  // a try behind one that was done is none of Slurm's
  } else if (cancelled || task.state == "CANCELLED") {
    chunk.state = State::cancelled;
  } else if (task.state == "FAILED") {
    chunk.state = State::failed;
  } else {
    chunk.state = State::lost;
    chunk.why = why_it_ended(task.state);
  }
}

/// Where it ran last and why it failed, as its last report says.
void explain(ChunkStatus& chunk, const AttemptFile& attempt) {
  const auto text = read_file(attempt.path);
  const Json json = text ? Json::parse(*text, nullptr, false) : Json();
  if (!json.is_object()) return;
  if (chunk.node.empty()) chunk.node = json.value("node", "");
  if (chunk.state != State::failed) return;
  chunk.why = json.value("error", "");
  if (chunk.why.empty() && attempt.exit_code) chunk.why = "its report could not be written; is the disk full?";
  if (!json.contains("run") || !json["run"].is_object() || !json["run"].contains("frames")) return;
  for (const auto& frame : json["run"]["frames"])
    if (frame.contains("error")) {
      chunk.why = frame["error"].get<std::string>();
      break;
    }
}

/// It waits for something that does not come by itself: somebody who releases it, other limits.
bool is_stuck(const ChunkStatus& chunk) {
  static const std::set<std::string_view> kUsual{"",           "none",      "priority",          "resources",
                                                 "dependency", "begintime", "jobarraytasklimit", "cleaning",
                                                 "prolog",     "licenses"};
  return chunk.state == State::waiting && !kUsual.contains(chunk.why);
}

std::string chunk_name(const Chunk& chunk) {
  if (!chunk.frames.empty()) return chunk.frames;
  const std::string first = chunk.inputs.empty() ? "" : chunk.inputs.front();
  return chunk.inputs.size() > 1 ? fmt::format("{} … ({})", first, chunk.inputs.size()) : first;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

std::size_t JobStatus::count(State state) const {
  return static_cast<std::size_t>(std::ranges::count(chunks, state, &ChunkStatus::state));
}

bool JobStatus::live() const {
  return std::ranges::any_of(chunks, [](const ChunkStatus& chunk) {
    return chunk.state == State::waiting || chunk.state == State::running || chunk.state == State::ending;
  });
}

Result<JobStatus> status_of(const Job& job) {
  JobStatus status;
  status.frames = job.frames();
  AFTERGLOW_TRY(const Submissions submissions, read_submissions(job));
  for (const auto& array : submissions.arrays) status.arrays.push_back(array.id);
  std::vector<AttemptFile> attempts;
  bool again = false;
  const auto look = [&]() -> Result<void> {
    AFTERGLOW_TRY(attempts, attempts_of(job));
    status.chunks.assign(job.tasks(), {});
    take_attempts(status, attempts);
    again = take_lost_video(job, status);
    return {};
  };
  AFTERGLOW_CHECK(look());
  TaskStates tasks;
  if (!submissions.arrays.empty() && !status.done()) {
    AFTERGLOW_TRY(tasks, task_states(submissions));
    AFTERGLOW_CHECK(look());  // what ended meanwhile is found ended
  }
  for (const auto& [chunk, task] : tasks) {
    if (chunk >= status.chunks.size() || (again && task.ended())) continue;
    take_task(status.chunks[chunk], task, submissions.cancelled);
  }
  for (auto& chunk : status.chunks)
    if (submissions.cancelled && (chunk.state == State::not_begun || chunk.state == State::lost))
      chunk.state = State::cancelled;
  // Of a job of another scheduler a try that began may well go on.
  if (submissions.arrays.empty())
    for (auto& chunk : status.chunks)
      if (chunk.state == State::lost && !chunk.exit_code) chunk.state = State::running, chunk.why = "or killed";
  for (const auto& attempt : attempts)
    if (status.chunks[attempt.chunk].state == State::failed || status.chunks[attempt.chunk].state == State::lost)
      explain(status.chunks[attempt.chunk], attempt);
  for (std::size_t i = 0; i < job.chunks.size(); ++i)
    if (status.chunks[i].state == State::done) status.frames_done += static_cast<std::size_t>(job.chunks[i].count);
  return status;
}

std::vector<std::size_t> tasks_to_retry(const Job& job, const JobStatus& status) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < status.chunks.size(); ++i) {
    const State state = status.chunks[i].state;
    const bool ended =
        state == State::not_begun || state == State::failed || state == State::lost || state == State::cancelled;
    // A join that waits for the other chunks has to wait for these too.
    if (ended || (job.is_join(i) && state == State::waiting && !out.empty())) out.push_back(i);
  }
  return out;
}

std::string status_line(const JobStatus& status) {
  std::vector<std::string> parts;
  for (const State state : {State::done, State::running, State::ending, State::waiting, State::failed, State::lost,
                            State::cancelled, State::not_begun}) {
    const std::size_t count = status.count(state);
    if (count > 0) parts.push_back(fmt::format("{} {}", count, word_of(state)));
  }
  return join(parts);
}

std::string waiting_line(const Job& job, const JobStatus& status) {
  JobStatus frames;
  std::set<std::string> nodes;
  for (std::size_t i = 0; i < job.chunks.size() && i < status.chunks.size(); ++i) {
    const ChunkStatus& chunk = frames.chunks.emplace_back(status.chunks[i]);
    if (chunk.state == State::running && !chunk.node.empty()) nodes.insert(chunk.node);
  }
  constexpr std::size_t kMostNamed = 4;
  std::string out = fmt::format("frames; of {} chunks {}", frames.chunks.size(), status_line(frames));
  if (nodes.size() > kMostNamed)
    out += fmt::format(" ({} nodes)", nodes.size());
  else if (!nodes.empty())
    out += fmt::format(" ({})", join(std::vector<std::string>(nodes.begin(), nodes.end()), " "));
  std::set<std::string> reasons;
  for (const ChunkStatus& chunk : status.chunks)
    if (is_stuck(chunk)) reasons.insert(chunk.why);
  if (!reasons.empty()) out += "; Slurm says: " + join(std::vector<std::string>(reasons.begin(), reasons.end()));
  if (!job.video.empty()) out += fmt::format("; the join is {}", word_of(status.chunks.back().state));
  return out;
}

std::string status_text(const Job& job, const JobStatus& status, bool all) {
  std::string out =
      fmt::format("{}: {}, {} of {} frames, {} chunks{}: {}\n", job.id, job.look, status.frames_done, status.frames,
                  job.chunks.size(), job.video.empty() ? "" : " and the join", status_line(status));
  if (!status.arrays.empty()) out += fmt::format("slurm: {}\n", join(status.arrays));
  Table table({"chunk", "frames", "state", "tries", "node", ""});
  std::size_t rows = 0;
  for (std::size_t i = 0; i < status.chunks.size(); ++i) {
    const ChunkStatus& chunk = status.chunks[i];
    if (!all && (chunk.state == State::done || (chunk.state == State::waiting && !is_stuck(chunk)))) continue;
    ++rows;
    table.add({fmt::format("{}", i), job.is_join(i) ? "join" : chunk_name(job.chunks[i]), word_of(chunk.state),
               fmt::format("{}", chunk.tries), chunk.node, first_line(chunk.why)});
  }
  return rows > 0 ? out + table.text("  ") : out;
}

Result<void> outcome_of(const Job& job, const JobStatus& status) {
  if (status.done()) return {};
  std::size_t done = status.count(State::done);
  int code = 0;
  const ChunkStatus* first = nullptr;
  for (const auto& chunk : status.chunks) {
    if (chunk.state == State::done) continue;
    if (!first || (first->why.empty() && !chunk.why.empty())) first = &chunk;
    if (chunk.state == State::failed && chunk.exit_code) code = std::max(code, *chunk.exit_code);
  }
  const bool stopped = status.count(State::cancelled) > 0;
  ErrorKind kind = stopped ? ErrorKind::interrupted : ErrorKind::other;
  for (const ErrorKind known : {ErrorKind::usage, ErrorKind::script, ErrorKind::io, ErrorKind::device})
    if (!stopped && code == static_cast<int>(known)) kind = known;
  Error error{kind,
              fmt::format("{} of {} chunks{} are not done ({})", status.chunks.size() - done, job.chunks.size(),
                          job.video.empty() ? "" : " and the join", status_line(status)),
              job.folder.string()};
  if (first && !first->why.empty()) error.trail.push_back(first_line(first->why));
  error.trail.push_back("`afterglow farm retry` makes what is missing");
  return error;
}

}  // namespace afterglow::farm
