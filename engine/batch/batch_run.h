// SPDX-License-Identifier: MIT
// A whole run over pictures, sequences or clips: which files, by which preset, how, and what becomes of them. What
// `afterglow run` and whoever else works through many pictures calls.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "batch/frame_list.h"
#include "batch/frame_loop.h"
#include "batch/lock.h"
#include "batch/run_events.h"
#include "batch/run_report.h"
#include "core/result.h"
#include "core/written_files.h"
#include "session/session.h"

namespace afterglow {

struct BatchRequest {
  std::filesystem::path preset;
  SessionOptions session;  ///< the number of frames in flight is the run's own choice
  FrameListRequest files;
  FrameLoopOptions loop;    ///< auxiliary inputs, the colour space of inputs, histories and notes are found by the run
  std::string input_space;  ///< colour space of the pictures; empty: that of the stack
  std::optional<int> pre_roll;   ///< earlier frames for effects that look back; empty: as many as they ask for
  bool resume = false;           ///< outputs that were made by the same look of the same inputs are kept: see resume.h
  bool watch = false;            ///< inputs may still be written: frames run as they appear whole, and as they change
  PixelOptions pixel_options;    ///< everything besides the preset that changes pixels, for locks and `resume`
  std::filesystem::path lock;    ///< where to write what the run was made with; empty: nowhere
  std::filesystem::path locked;  ///< a lock that the run must agree with; empty: none
  std::vector<SideFile> beside;  ///< what is written besides, `lock` too: must be none of the pictures and the look
};

/// What frames write and read.
struct FilesOfFrames {
  std::vector<std::filesystem::path> outputs, read;
  /// Files that it shares with the frame before are named once: a video has many frames.
  void add(const FrameJob& frame);

 private:
  std::vector<std::filesystem::path> last_;
};

/// Refuses what the request would write over its own files: those of its frames, those that `look` is made of and those
/// that options name. Errors: usage, io (a file besides that may not be written).
Result<void> check_written(const BatchRequest& request, FilesOfFrames frames,
                           const std::vector<std::filesystem::path>& look);

/// Sets the rate of a video (FrameLoopOptions::takes_fps) to that which its first picture says. Whether it says one.
bool take_fps(BatchRequest& request, const std::vector<FrameJob>& frames);

/// Runs it. `report` holds what is known when it returns, also after an error. Errors: usage, script, io, device,
/// interrupted, as FrameLoop::run, Session::open, list_frames and the functions of lock.h and resume.h say.
Result<void> run_batch(const BatchRequest& request, const RunEvents& events, RunReport& report);

/// A part of a video that was written by a run with VideoOptions::piece, and how many frames it has.
struct VideoPart {
  std::filesystem::path file;
  std::size_t frames = 0;
};
/// Whether frames that several runs make in parts can become the request's output: pictures, or one video that is
/// joined. For errors before any work. Errors: usage, io.
Result<void> check_parts(const BatchRequest& request, const std::vector<FrameJob>& frames, Diagnostics& diagnostics);
/// That video of its parts, without a second encode: times, sound, subtitles, chapters and texts as in one run over all
/// `frames`. Errors: usage, io (a part is missing or is none of this video), interrupted.
Result<void> join_parts(const BatchRequest& request, const std::vector<FrameJob>& frames,
                        const std::vector<VideoPart>& parts, const RunEvents& events);

}  // namespace afterglow
