// SPDX-License-Identifier: MIT
// The frames of a run, one after the other; the next is read and the last is written while one is processed, if memory
// allows.
#pragma once

#include <deque>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "batch/non_finite_record.h"
#include "batch/run_events.h"
#include "batch/run_report.h"
#include "batch/scale.h"
#include "batch/schedule.h"
#include "core/hash.h"
#include "image/reader.h"
#include "image/writer.h"
#include "session/session.h"

namespace afterglow {

struct FrameLoopOptions {
  ReadOptions read;  ///< depth, normal and motion are those of each frame
  WriteOptions write;
  std::optional<SizeWish> size;  ///< of the display window; pictures are scaled to it before the stack
  std::optional<Rect> region;    ///< part of the display window that is wanted
  bool reuse = true;             ///< pictures that were just run are not run again
  double fps = 24;
  std::uint64_t max_memory = 6ull << 30;
  std::optional<Hash> record_look;  ///< leave notes for --resume
  bool fail_fast = false;
  NanPolicy nan_policy = NanPolicy::zero;  ///< fail: every pass of every frame is looked at, and nothing mended
  bool histories = false;                  ///< pictures depend on the frames before them
};

class FrameLoop {
 public:
  FrameLoop(Session& session, FrameLoopOptions options, RunEvents events);
  ~FrameLoop();

  /// Runs the frames of the schedule and notes in each what became of it. A frame whose files fail is reported and
  /// the rest go on; errors of the script or the device end the run. A frame of the pre-roll that fails is warned about
  /// and left out, as if it was not there. Errors: that of the only frame, or one that counts the failed ones.
  Result<void> run(Schedule& schedule);

  /// The header of a frame's picture, and what the preset says of that frame: kept for `run`, if it comes first there.
  /// Errors: those of reading the header and of the script.
  Result<std::shared_ptr<const Build>> inspect(const FrameJob& job);
  /// Pictures depend on the frames before them: see FrameLoopOptions.
  void follow_histories() { options_.histories = true; }
  /// Leaves notes for --resume.
  void record_look(const std::optional<Hash>& look) { options_.record_look = look; }

  std::uint64_t largest_need() const { return largest_need_; }

 private:
  struct Reading;
  struct Writing;
  struct Need {
    std::uint64_t device = 0, reading = 0, result = 0;  ///< bytes
    std::uint64_t one_frame() const { return device + reading + result; }
    std::uint64_t three_frames() const {
      return device + 2 * (reading + result);
    }  ///< one is read, one processed, one written
  };

  /// Of a frame whose picture has not been read.
  struct Planned {
    const FrameJob* job = nullptr;
    PictureHeader header;
    FrameRequest request;
  };
  ReadOptions read_options(const FrameJob& job) const;
  std::optional<Scaling> scaling_of(const PictureHeader& header) const;
  Result<FrameRequest> request_of(const FrameJob& job, const PictureHeader& header, double step, bool restart);
  Result<Planned> plan(const FrameJob& job, double step, bool restart);
  Result<Need> need_of(const PictureHeader& header, const Build& build, const FrameJob& job);
  std::unique_ptr<Reading> begin_reading(const ScheduledFrame& scheduled);
  Result<void> place_in_time(Reading& reading);
  std::size_t ahead() const;
  Result<void> process(std::unique_ptr<Reading> reading);
  Result<void> begin(Reading& reading, Picture picture);
  Result<void> finish_running();
  Result<void> failed(const Reading& reading, Error error);
  Result<void> make(Reading& reading, Picture& picture);
  Result<Trace> trace_again(const Reading& reading);
  Result<void> mend(Reading& reading, Picture& picture);
  void begin_writing(FrameRecord& frame, Picture picture);
  Result<void> finish_writing();
  Result<void> fail(FrameRecord& frame, Error error, bool pre_roll = false);
  Result<void> close(Result<void> result);

  Session& session_;
  FrameLoopOptions options_;
  RunEvents events_;
  std::deque<std::unique_ptr<Reading>> running_;  ///< whose frames are in flight, the oldest first
  std::optional<Planned> planned_;
  std::unique_ptr<Writing> writing_;
  NonFiniteRecord non_finite_;
  std::size_t total_ = 0, pre_roll_ = 0, done_ = 0, failed_ = 0;
  std::uint64_t largest_need_ = 0;
  bool overlap_ = false;
  std::optional<int> last_;   ///< number of the frame that the next one follows
  std::optional<int> begun_;  ///< number of the frame that was evaluated last
};

}  // namespace afterglow
