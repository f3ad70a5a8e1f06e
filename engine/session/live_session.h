// SPDX-License-Identifier: MIT
// A LiveStack and what runs it: pictures in, source and result on the device. What a player drives.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "image/picture.h"
#include "session/live.h"

namespace afterglow {

/// Drawing thread alone.
class LiveSession {
 public:
  /// See LiveStack::open. Images between kernels are kept as `options.stack.keep_images` says: then after an edit only
  /// what it changes runs again. The device must outlive it. Errors: device.
  static Result<std::unique_ptr<LiveSession>> open(Device& device, const std::filesystem::path& preset,
                                                   const LiveOptions& options, Diagnostics& diagnostics);
  ~LiveSession();

  LiveStack& live();

  /// Takes what has been built, then runs the stack on the picture and leaves source and result on the device. Without
  /// a good stack yet the source is the result. `frame` gives frame number, time, fps and position; sizes are taken
  /// from the picture, which is read during the call alone. A picture of another size than before waits for its build.
  /// Pictures whose `content` is known (note_content) are uploaded once, and kernels for which nothing has changed do
  /// not run again. Whoever reads `images` must be done with them: a submission that does has to be waited for. Errors:
  /// script (at this frame), io (memory limit), device. `images` are then those of the frame before.
  Result<void> process(const Picture& picture, const BuildContext& frame = {},
                       KernelTiming timing = KernelTiming::none);

  /// Frames whose structure is another one than there are programs for: from now on built beside the drawing thread
  /// (true), while `process` leaves the images as they were and `waits` says so; or in `process` itself (false, as at
  /// first). What moves faster than it can be built is built in `process` all the same, every few frames.
  void build_aside(bool aside);
  /// The last `process` made nothing of its frame: its structure is being built. LiveOptions::notify tells when it is.
  bool waits() const;
  /// One kernel of the last frame, another one each time, is run once more by itself and timed; false when there is
  /// nothing to time. Whoever reads `images` must be done with them. Errors: device.
  Result<bool> time_a_kernel();
  /// What `time_a_kernel` has found, of the kernels that it has met.
  std::vector<KernelTime> kernel_times() const;
  /// Whether all kernels of the last frame's program have been timed since it was made.
  bool all_timed() const;

  /// Of the last `process`. See Renderer::images.
  DeviceImages images() const;
  /// Reads the result back; an error when nothing had to run (`images().ran`). See Renderer::read_result.
  Result<void> read_result(HostResult& out, const std::optional<Rect>& part = {});

  const FrameTimes& times() const;  ///< of the last frame
  /// What the last frame left out, with reasons: effects, passes, what was done before.
  std::vector<Skipped> skipped() const;
  std::vector<std::string> kernels() const;  ///< that the last frame's program has, fused passes as "a+b"
  ProgramMemory memory() const;
  Renderer::Counters counters() const;

 private:
  struct State;
  explicit LiveSession(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace afterglow
