// SPDX-License-Identifier: MIT
#include "apps/farm_chunk.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <system_error>

#include "apps/farm_arguments.h"
#include "apps/run_events.h"
#include "farm/attempt.h"

namespace afterglow {
namespace {

Result<std::size_t> chunk_number(const farm::Job& job, const std::string& text) {
  std::size_t number = 0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (ec != std::errc() || end != text.data() + text.size() || number >= job.chunks.size())
    return Error{ErrorKind::usage, fmt::format("there is no chunk '{}'", text), job.folder.string(), 0,
                 fmt::format("0 to {}", job.chunks.size() - 1)};
  return number;
}

Result<void> run_frames_of(const farm::Job& job, std::size_t number, const RunEvents& events, RunReport& report) {
  AFTERGLOW_CHECK(farm::check_packed(job));
  std::error_code ec;
  std::filesystem::current_path(job.at, ec);
  if (ec) return Error{ErrorKind::io, fmt::format("cannot be entered: {}", ec.message()), job.at.string()};
  for (const auto& [name, value] : job.environment)
    value.empty() ? unsetenv(name.c_str()) : setenv(name.c_str(), value.c_str(), 1);
  AFTERGLOW_TRY(BatchRequest request, request_of_words(job.run));
  const farm::Chunk& chunk = job.chunks[number];
  request.files.inputs = chunk.inputs;
  request.files.frames = chunk.frames;
  request.resume = true;
  if (job.pre_roll) request.pre_roll = job.pre_roll;
  return run_batch(request, events, report);
}

}  // namespace

Result<void> run_chunk(const std::string& job_folder, const std::string& number, Console& console) {
  AFTERGLOW_TRY(const farm::Job job, farm::read_job(job_folder));
  AFTERGLOW_TRY(const std::size_t chunk, chunk_number(job, number));
  AFTERGLOW_TRY(const farm::Attempt attempt, farm::Attempt::begin(job, chunk));
  RunReport report;
  auto done = run_frames_of(job, chunk, run_events(console), report);
  const int exit_code = done ? 0 : static_cast<int>(done.error().kind);
  const auto noted = attempt.end(exit_code, done ? "" : done.error().text(), report_json(report));
  return done && !noted ? noted : done;
}

}  // namespace afterglow
