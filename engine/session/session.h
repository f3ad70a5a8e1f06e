// Preset + pictures → pictures. What the command line, the player and tests share: a Stack, a device of its own, and
// the transfers.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "exec/frame.h"
#include "image/picture.h"
#include "session/stack.h"

namespace afterglow {

struct SessionOptions {
  DeviceOptions device;
  StackOptions stack;
  KernelTiming timing = KernelTiming::none;
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
  std::vector<Skipped> skipped;      ///< effects and passes that did not run in the last frame, with reasons
  std::vector<std::string> kernels;  ///< what ran, joined passes as "a+b"
  ProgramMemory memory;
  std::uint64_t clamped = 0;  ///< half storage: samples of the last frame held at ±65504
  SessionTimes times;
};

/// Not thread-safe.
class Session {
 public:
  /// Loads the preset while the device opens. Errors: script, device, usage (unknown override).
  static Result<std::unique_ptr<Session>> open(const std::filesystem::path& preset, const SessionOptions& options,
                                               Diagnostics& diagnostics);
  ~Session();

  Stack& stack();
  Preset& preset() { return stack().preset(); }
  Device& device();

  /// Makes everything that a picture of this size needs; `process` does it otherwise. May run while the picture is
  /// being read.
  Result<void> prepare(const BuildContext& context, const std::optional<DisplayEncoding>& encoding = {});
  /// Runs the stack: `picture.color` becomes the result; its alpha stays. A stack with nothing to do leaves the picture
  /// untouched. `frame` gives frame number, time and fps; sizes are taken from the picture.
  /// With `encoding` the result may come as `picture.codes` instead, and `picture.color` stays the source.
  Result<void> process(Picture& picture, const BuildContext& frame = {},
                       const std::optional<DisplayEncoding>& encoding = {});
  SessionReport report() const;

 private:
  struct State;
  explicit Session(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace afterglow
