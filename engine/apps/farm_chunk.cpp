// SPDX-License-Identifier: MIT
#include "apps/farm_chunk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <system_error>

#include "apps/farm_arguments.h"
#include "apps/run_events.h"
#include "core/file.h"
#include "core/parse_number.h"
#include "core/temporary.h"
#include "farm/attempt.h"

namespace afterglow {
namespace {

Result<std::size_t> task_number(const farm::Job& job, const std::string& text) {
  const auto number = parse_number<std::size_t>(text);
  if (!number || *number >= job.tasks())
    return Error{ErrorKind::usage, fmt::format("there is no chunk '{}'", text), job.folder.string(), 0,
                 fmt::format("0 to {}", job.chunks.size() - 1)};
  return *number;
}

/// What the job was submitted with, with its folder as the current one.
Result<BatchRequest> request_of(const farm::Job& job) {
  AFTERGLOW_CHECK(farm::check_packed(job));
  std::error_code ec;
  std::filesystem::current_path(job.at, ec);
  if (ec) return Error{ErrorKind::io, fmt::format("cannot be entered: {}", ec.message()), job.at.string()};
  for (const auto& [name, value] : job.environment)
    value.empty() ? unsetenv(name.c_str()) : setenv(name.c_str(), value.c_str(), 1);
  return request_of_words(job.run);
}

Result<void> make_frames(const farm::Job& job, std::size_t number, const RunEvents& events, RunReport& report) {
  AFTERGLOW_TRY(BatchRequest request, request_of(job));
  const farm::Chunk& chunk = job.chunks[number];
  request.files.inputs = chunk.inputs;
  request.files.frames = chunk.frames;
  if (job.pre_roll) request.pre_roll = job.pre_roll;
  request.loop.whole_pre_roll = true;
  request.resume = job.video.empty();
  if (!job.video.empty()) {
    request.files.output = job.piece(number).string();
    AFTERGLOW_CHECK(make_folder(job.pieces()));  // a join has removed it
    request.loop.write.video.piece = true;
    request.loop.keep_partial = false;
    request.loop.fail_fast = true;  // a piece with holes is none
  }
  return run_batch(request, events, report);
}

Result<void> join_all(const farm::Job& job, const RunEvents& events) {
  AFTERGLOW_TRY(BatchRequest request, request_of(job));
  std::vector<VideoPart> parts;
  for (std::size_t i = 0; i < job.chunks.size(); ++i) {
    parts.push_back({job.piece(i), static_cast<std::size_t>(job.chunks[i].count)});
    if (!is_file(parts.back().file))
      return Error{ErrorKind::io, fmt::format("waits for chunk {}, which is not done", i), job.video, 0,
                   "`afterglow farm retry` first"};
  }
  std::vector<FrameJob> frames;
  for (const farm::Chunk& inputs : job.inputs()) {
    request.files.inputs = inputs.inputs;
    request.files.frames = inputs.frames;
    AFTERGLOW_TRY(FrameList list, list_frames(request.files, events.diagnostics));
    std::ranges::move(list.jobs, std::back_inserter(frames));
  }
  if (job.holds_missing) hold_missing(frames);
  AFTERGLOW_CHECK(join_parts(request, frames, parts, events));
  // All at once: who joins at the same time misses one only when the video is there.
  const Temporary done(job.pieces());
  std::error_code ignored;
  std::filesystem::rename(job.pieces(), done.path(), ignored);
  return {};
}

/// The last thing that a join does is to take the pieces away.
bool was_joined(const farm::Job& job) {
  std::error_code ec;
  return !std::filesystem::exists(job.pieces(), ec) && is_file(job.video);
}

Result<void> join_pieces(const farm::Job& job, const RunEvents& events) {
  if (!was_joined(job)) {
    auto done = join_all(job, events);
    if (done || !was_joined(job)) return done;
  }
  events.diagnostics.note(fmt::format("{} was joined before", job.video));
  return {};
}

/// A try of a task, with a note of how it went.
Result<void> run_task(const farm::Job& job, std::size_t task, Console& console) {
  AFTERGLOW_TRY(const farm::Attempt attempt, farm::Attempt::begin(job, task));
  RunReport report;
  const RunEvents events = run_events(console);
  auto done = job.is_join(task) ? join_pieces(job, events) : make_frames(job, task, events, report);
  const int exit_code = done ? 0 : static_cast<int>(done.error().kind);
  const std::string made = job.is_join(task) ? "" : report_json(report);
  const auto noted = attempt.end(exit_code, done ? "" : done.error().text(), made);
  return done && !noted ? noted : done;
}

}  // namespace

Result<void> run_chunk(const std::string& job_folder, const std::string& number, Console& console) {
  AFTERGLOW_TRY(const farm::Job job, farm::find_job(job_folder));
  AFTERGLOW_TRY(const std::size_t task, task_number(job, number));
  return run_task(job, task, console);
}

Result<void> run_join(const farm::Job& job, Console& console) {
  if (job.video.empty())
    return Error{ErrorKind::usage, "has pictures as outputs; there is nothing to join", job.folder.string()};
  return run_task(job, job.chunks.size(), console);
}

}  // namespace afterglow
