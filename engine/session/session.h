// SPDX-License-Identifier: MIT
// Preset + pictures → pictures. What the command line, the player and tests share: a Stack, a device of its own, and
// the transfers.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image/picture.h"
#include "session/stack.h"
#include "session/trace.h"

namespace afterglow {

struct SessionOptions {
  DeviceOptions device;
  StackOptions stack;
  KernelTiming timing = KernelTiming::none;
  /// Frames in flight at most, where pixels take the way over staging buffers: see RendererOptions.
  int frames = 1;
  /// False takes that way on every device.
  bool direct = true;
};

/// Milliseconds: since the session began (device, script, compile) and of the last frame (upload, execute, read-back).
struct SessionTimes {
  double device = 0, script = 0, compile = 0;
  FrameTimes frame;
};

struct SessionReport {
  std::string device, driver, preset;
  StackChoice choice;
  bool reference = false;
  std::vector<Skipped> skipped;  ///< effects and passes that no frame of this size runs, with reasons
  /// What the last frame did not run besides, because of its content, or because it was done before.
  std::vector<Skipped> skipped_now;
  std::vector<std::string> kernels;  ///< what ran in the last frame, fused passes as "a+b"
  ProgramMemory memory;
  std::uint64_t clamped = 0;  ///< half storage: samples of the last frame held at ±65504
  /// With StackOptions::flag_non_finite: the last frame met a colour that is not finite, see ProgramOptions. Pixels
  /// whose alpha rounds to 0 of 255 are not seen where the result is codes with straight alpha.
  bool flagged = false;
  SessionTimes times;
  struct Counters {
    int programs = 0, images = 0, buffers = 0;
    std::uint64_t evaluations = 0;  ///< of the preset: one a frame
  } counters;                       ///< objects made so far; steady frames leave them alone
};

/// Not thread-safe.
class Session {
 public:
  /// Loads the preset and opens the device. Errors: script, device, usage (unknown override).
  static Result<std::unique_ptr<Session>> open(const std::filesystem::path& preset, const SessionOptions& options,
                                               Diagnostics& diagnostics);
  /// Loads the preset alone: until `ready`, only `preset` and `evaluate` may be used, and of `stack` what needs no
  /// device. `diagnostics` must stay until then. Errors: script, usage.
  static Result<std::unique_ptr<Session>> begin(const std::filesystem::path& preset, const SessionOptions& options,
                                                Diagnostics& diagnostics);
  /// Begins to open the device on a thread of its own. Call it behind what is to run meanwhile: while a driver is being
  /// loaded, which takes most of the time, no other thread can begin in the whole process.
  void begin_opening();
  /// Opens the device, or waits for that, the first time. Errors: device.
  Result<void> ready();
  ~Session();

  Stack& stack();
  Preset& preset() { return stack().preset(); }
  Device& device();

  /// See Stack::evaluate: once a frame, for all that is asked about it and done with it.
  Result<std::shared_ptr<const Build>> evaluate(const BuildContext& context) { return stack().evaluate(context); }
  /// Makes everything that a frame needs; `process` does it otherwise. May run while the picture is being read.
  Result<void> prepare(FrameRequest frame);
  /// How many frames may be in flight: submitted and not collected.
  int frames() const;
  int in_flight() const;
  /// The first half of `process`, which goes on while the device works. A frame that nothing runs for is in flight like
  /// any other. Errors: as of `process`, some of which `collect` tells where several may be in flight; the picture is
  /// lost then.
  Result<void> submit(Picture picture, FrameRequest request);
  /// The second half, of the oldest frame that is in flight; `report` is of it then. `picture` gets what was submitted,
  /// as `process` leaves it, also where it fails.
  Result<void> collect(Picture& picture);

  /// Runs the stack: `picture.color` becomes the result; its alpha stays. A stack with nothing to do leaves the picture
  /// untouched. The request's build was evaluated for this size and these auxiliary images.
  /// With `encoding` the result may come as `picture.unorm8` instead, and `picture.color` stays the source.
  /// With `region`, in pixels of the picture and within it, that part of the result is made and the rest is undefined.
  /// Pictures whose `content` is known and was there before are not run again while settings stay.
  Result<void> process(Picture& picture, FrameRequest request);
  /// Evaluates and processes: `frame` gives frame number, time and fps; sizes are taken from the picture.
  Result<void> process(Picture& picture, const BuildContext& frame = {},
                       const std::optional<DisplayEncoding>& encoding = {}, const std::optional<Rect>& region = {});
  /// Which passes make what is not finite in a frame, and its mended result: see session/trace.h. The frame that was
  /// processed last, or the next one that will be; arguments are those of `process`.
  Result<Trace> trace(const Picture& picture, const FrameRequest& request, NanPolicy policy);
  /// The last result was replaced by that of a trace: none of its samples was held at what half floats hold.
  void forget_clamped();
  /// Names of histories that held a frame and began anew since this was asked last: passes that they are made of, or
  /// their size, were others.
  std::vector<std::string> take_replaced_histories();
  SessionReport report() const;

 private:
  struct State;
  explicit Session(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace afterglow
