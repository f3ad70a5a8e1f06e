// SPDX-License-Identifier: MIT
// The frames of a run, one after the other; the next is read and the last is written while one is processed, if memory
// allows.
#pragma once

#include <deque>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "batch/frame_plan.h"
#include "batch/frame_sink.h"
#include "batch/non_finite_record.h"
#include "batch/resume.h"
#include "batch/run_events.h"
#include "batch/run_report.h"
#include "batch/schedule.h"
#include "batch/sequence_record.h"
#include "batch/write_queue.h"
#include "image/cuts.h"
#include "image/reader.h"
#include "image/writer.h"
#include "session/session.h"

namespace afterglow {

class FrameLoop {
 public:
  /// `session` and `sink` outlive it.
  FrameLoop(Session& session, FrameSink& sink, FrameLoopOptions options, RunEvents events);
  ~FrameLoop();

  /// Runs the frames of the schedule and notes in each what became of it. A frame whose files fail is reported and
  /// the rest go on; errors of the script or the device end the run. A frame of the pre-roll that fails is warned about
  /// and left out, as if it was not there. Errors: that of the only frame, or one that counts the failed ones.
  Result<void> run(Schedule& schedule);

  /// The header of a frame's picture, and what the preset says of that frame: kept for `run`, if it comes first there.
  /// Errors: those of reading the header and of the script.
  Result<std::shared_ptr<const Build>> inspect(const FrameJob& job);
  /// See FramePlanner.
  Size size_of(const PictureHeader& header) const { return planner_.size_of(header); }
  /// See FramePlanner: what the first picture refuses, all others would.
  Result<void> check_region(const PictureHeader& header) const { return planner_.check_region(header); }
  /// Pictures depend on the frames before them: see FrameLoopOptions.
  void follow_histories(int pre_roll) {
    options_.histories = true;
    pre_roll_frames_ = pre_roll;
  }
  /// Each frame gets its FrameJob::made_of. `notes` outlives the loop.
  void note_frames(FrameNotes& notes) { notes_ = &notes; }
  /// All frames of the run, those that need not be made too: what other frames of a sequence have. They outlive it.
  void know_frames(const FrameRecords& frames);
  /// Pictures are those of a display's view: Picture::view.
  void show_view() { options_.view = true; }

  std::uint64_t largest_need() const { return planner_.largest_need(); }

 private:
  struct Reading;
  bool fetch(Schedule& schedule, std::size_t place);
  bool several() const { return endless_ || total_ + pre_roll_ > 1; }
  static bool runs(const Reading& reading);
  bool halves_suffice(const Reading& reading) const;
  std::unique_ptr<Reading> begin_reading(const ScheduledFrame& scheduled);
  void begin_further(Schedule& schedule, std::deque<std::unique_ptr<Reading>>& next, std::size_t& begun,
                     std::size_t most);
  bool looks_for_cuts(const FrameJob& job) const;
  bool begins_shot(const Reading& reading) const;
  void begin_shot();
  Result<void> place_in_time(Reading& reading);
  std::size_t ahead() const;
  Result<void> process(std::unique_ptr<Reading> reading);
  Result<void> begin(Reading& reading, Picture picture);
  void note_gap(const FrameJob& job);
  bool has_gap(const FrameJob& job) const;
  Result<void> finish_running();
  Result<void> failed(const Reading& reading, Error error);
  SharedSkips share_skips(const std::vector<Skipped>& skips);
  Result<void> make(Reading& reading, Picture& picture);
  Result<Trace> trace_again(const Reading& reading);
  Result<void> mend(Reading& reading, Picture& picture);
  Result<void> finish_writing(std::size_t left);
  Result<void> finish_sink(const Result<void>& result);
  Result<void> fail(FrameRecord& frame, Error error, bool pre_roll = false, bool told_later = false);
  Result<void> close(Result<void> result);
  Error full() const;

  Session& session_;
  FrameSink& sink_;
  FrameNotes* notes_ = nullptr;  ///< null: none are wanted
  FrameLoopOptions options_;
  RunEvents events_;
  FramePlanner planner_;
  PixelMemory memory_;                            ///< of pictures that are read; before what uses it
  std::deque<std::unique_ptr<Reading>> running_;  ///< whose frames are in flight, the oldest first
  std::optional<PlannedFrame> planned_;
  WriteQueue writing_;
  NonFiniteRecord non_finite_;
  std::size_t total_ = 0, pre_roll_ = 0, done_ = 0, failed_ = 0;
  std::size_t places_ = 0;              ///< of frames that are written, with those of missing ones
  const Schedule* schedule_ = nullptr;  ///< that runs
  bool full_ = false;                   ///< the disk: no frame is begun any more
  bool endless_ = false;                ///< nobody knows how many frames will come
  std::optional<Error> stream_error_;
  Overlap overlap_;
  std::map<std::string, int> replaced_;  ///< histories that began anew within a sequence, and in how many frames
  std::optional<int> last_;              ///< number of the frame that the next one follows
  ShotSketch last_sketch_;               ///< of the last picture of its shot that is not blank
  int blank_frames_ = 0;                 ///< made behind that one
  int pre_roll_frames_ = 0;              ///< that a part of a sequence runs first
  std::vector<std::size_t> gaps_;        ///< places of frames of its sequence that are not in its history: they failed
  std::optional<int> begun_;             ///< number of the frame that was evaluated last
  SequenceRecord sequences_;
  std::deque<SharedSkips> skips_;  ///< of frames so far, the newest first
};

}  // namespace afterglow
