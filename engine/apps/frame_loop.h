// The frames of a run, one after the other; the next is read and the last is written while one is processed, if memory
// allows.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "apps/console.h"
#include "apps/non_finite_record.h"
#include "apps/run_report.h"
#include "apps/scale.h"
#include "apps/schedule.h"
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
  FrameLoop(Session& session, FrameLoopOptions options, Console& console);
  ~FrameLoop();

  /// Runs the frames of the schedule and notes in each what became of it. A frame whose files fail is reported and
  /// the rest go on; errors of the script or the device end the run. A frame of the pre-roll that fails is warned about
  /// and left out, as if it was not there. Errors: that of the only frame, or one that counts the failed ones.
  Result<void> run(Schedule& schedule);

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

  Result<Need> need_of(const PictureHeader& header, const BuildContext& context, const FrameJob& job);
  std::unique_ptr<Reading> begin_reading(const ScheduledFrame& scheduled);
  void place_in_time(Reading& reading);
  Result<void> process(Reading& reading);
  Result<void> make(Reading& reading, Picture& picture);
  Result<Trace> trace_again(const Reading& reading);
  Result<void> mend(Reading& reading, Picture& picture);
  void begin_writing(FrameRecord& frame, Picture picture);
  Result<void> finish_writing();
  Result<void> fail(FrameRecord& frame, Error error, bool pre_roll = false);
  Result<void> close(Result<void> result);

  Session& session_;
  FrameLoopOptions options_;
  Console& console_;
  std::unique_ptr<Writing> writing_;
  NonFiniteRecord non_finite_;
  std::size_t total_ = 0, pre_roll_ = 0, done_ = 0, failed_ = 0;
  std::uint64_t largest_need_ = 0;
  bool overlap_ = false;
  std::optional<int> last_;  ///< number of the frame that the next one follows
};

}  // namespace afterglow
