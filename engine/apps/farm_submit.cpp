// SPDX-License-Identifier: MIT
#include "apps/farm_submit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include "apps/farm_rival.h"
#include "core/file.h"
#include "core/inside.h"
#include "core/own_file.h"
#include "core/version.h"
#include "farm/look.h"
#include "farm/slurm.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

constexpr int kUsualChunk = 24;
constexpr int kChunksToPreRoll = 4;  // at most a fifth of the work is done twice

/// The folder of the outputs, beside which the job lies.
fs::path folder_of_outputs(const std::string& output) {
  std::error_code ec;
  if (output.ends_with('/') || fs::is_directory(output, ec)) return output;
  return fs::path(output).parent_path();
}

int frames_a_chunk(const FarmArguments& arguments, const farm::LoadedLook& look) {
  if (arguments.chunk > 0) return arguments.chunk;
  return std::max(kUsualChunk, kChunksToPreRoll * look.pre_roll.value_or(0));
}

/// Effects that look back find the frames before a chunk by the pattern alone.
Result<void> check_sequences(const PlannedJob& planned) {
  if (!planned.job.pre_roll) return {};
  for (const auto& chunk : planned.job.chunks)
    if (chunk.frames.empty())
      return Error{ErrorKind::usage,
                   fmt::format("{} is no sequence, and the look has effects that look back at other frames",
                               chunk.inputs.front()),
                   "afterglow farm", 0, "sequences like shot.####.exr"};
  return {};
}

/// Frames that are still to be rendered may be submitted; whoever has mistaken their numbers sees it here.
void tell_not_there_yet(const std::vector<FrameJob>& frames, Diagnostics& diagnostics) {
  const auto missing = [](const FrameJob& frame) { return !frame.movie && !is_file(frame.input); };
  const auto count = std::ranges::count_if(frames, missing);
  if (count > 0)
    diagnostics.warn(fmt::format("{} of {} frames are not there yet: {}", count, frames.size(),
                                 std::ranges::find_if(frames, missing)->input.string()));
}

/// Chunks have files of their own, and read files that all machines see.
Result<void> check_streams(const FrameListRequest& files) {
  if (files.output == "-" || std::ranges::count(files.inputs, "-") > 0)
    return Error{ErrorKind::usage, "'-' is a stream of one machine", "afterglow farm", 0, "files"};
  return {};
}

Result<void> pack(const FarmArguments& arguments, const BatchRequest& request, const std::vector<FrameJob>& frames,
                  const farm::LoadedLook& look, farm::Job& job, Console& console) {
  const bool of_pictures = !frames.empty() && !frames.front().movie;
  AFTERGLOW_CHECK(farm::pack_look(look, job));
  const fs::path shipped = find_installation() / "calibration" / "devices.json";
  const std::string& given = arguments.run.execution.calibration;
  if (!given.empty() || is_file(shipped))
    AFTERGLOW_CHECK(farm::pack_file(given.empty() ? shipped : fs::path(given), "look/calibration.json", job));
  job.run = arguments.packed_words(request.preset, job.folder);
  // The same for every chunk, whose first picture is another; frames of a video have their own times.
  if (!arguments.run.fps && !job.video.empty() && of_pictures)
    job.run.insert(job.run.begin(), fmt::format("--fps={}", request.loop.fps));
  job.environment = look.environment;
  job.environment["AFTERGLOW_PATH"] = "";
  if (const char* home = std::getenv("AFTERGLOW_HOME"); home && *home)
    job.environment["AFTERGLOW_HOME"] = fs::absolute(home).lexically_normal().string();
  if (const char* config = std::getenv("OCIO"); config && is_file(farm::packed_place(job.folder, config)))
    job.environment["OCIO"] = farm::packed_place(job.folder, config).string();
  unsetenv("AFTERGLOW_PATH");  // its folders are among the words
  AFTERGLOW_TRY(const BatchRequest packed, request_of_words(job.run));
  AFTERGLOW_CHECK(farm::lock_packed_look(packed, frames, arguments.run.locked, job, console.diagnostics()));
  AFTERGLOW_CHECK(farm::write_task_script(job));
  return farm::write_job(job);
}

}  // namespace

Result<PlannedJob> plan_job(const FarmArguments& arguments, bool write, Console& console) {
  AFTERGLOW_TRY(BatchRequest request, arguments.run.request());
  arguments.run.preset.tell_of_namesake(request.preset, console.diagnostics());
  PlannedJob out{.files = request.files};
  AFTERGLOW_CHECK(check_streams(request.files));
  AFTERGLOW_TRY(FrameList list, list_frames(request.files, console.diagnostics()));
  out.frames = std::move(list.jobs);
  const bool video = is_one_output(request.files.output);
  take_fps(request, out.frames);
  AFTERGLOW_CHECK(check_parts(request, out.frames, console.diagnostics()));
  tell_not_there_yet(out.frames, console.diagnostics());
  AFTERGLOW_TRY(const auto look, farm::load_look(request, out.frames, console.diagnostics()));
  request.beside.push_back({"--jobs", arguments.jobs});
  FilesOfFrames files;
  for (const FrameJob& frame : out.frames) files.add(frame);
  AFTERGLOW_CHECK(check_written(request, std::move(files), look.files));
  farm::Job& job = out.job;
  std::error_code ec;
  job.program = own_file().string();
  job.version = version();
  job.at = fs::current_path(ec);
  job.look = arguments.run.preset.file;
  if (video) job.video = whole_path(job.at / request.files.output).string();
  job.holds_missing = std::ranges::any_of(out.frames, [](const FrameJob& frame) { return frame.missing > 0; });
  job.pre_roll = look.pre_roll;
  job.needs = arguments.needs;
  job.chunks = farm::chunks_of(out.frames, frames_a_chunk(arguments, look));
  AFTERGLOW_CHECK(check_sequences(out));
  const fs::path outputs = folder_of_outputs(request.files.output);
  if (!write) {
    job.folder = whole_path(job.at / outputs) / farm::kFolder / farm::new_job_id();
    job.id = job.folder.filename().string();
    return out;
  }
  out.new_folder = new_folder(request.files.output);
  AFTERGLOW_CHECK(make_folder(out.new_folder));
  out.alone = std::make_unique<FileLock>(outputs.empty() ? "." : outputs);
  AFTERGLOW_CHECK(check_no_rival(out, outputs));
  AFTERGLOW_TRY(job.folder, farm::make_job_folder(outputs));
  job.id = job.folder.filename().string();
  const auto packed = pack(arguments, request, out.frames, look, job, console);
  if (packed) return out;
  discard(out);
  return packed.error();
}

void discard(const PlannedJob& planned) {
  farm::discard_job(planned.job);
  std::error_code ec;
  fs::remove(planned.new_folder, ec);
}

}  // namespace afterglow
