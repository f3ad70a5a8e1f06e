// Preset + pictures → pictures. What the command line, the player and embedding programs share.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "core/result.h"
#include "exec/frame.h"
#include "gpu/device.h"
#include "image/picture.h"
#include "script/preset.h"

namespace afterglow {

enum class Precision { automatic, fp32, fp16 };

struct SessionOptions {
  DeviceOptions device;
  PresetOptions preset;
  Precision precision = Precision::automatic;
  std::optional<double> max_error;      ///< E; default: the preset's, else 2e-3
  bool reference = false;
  std::uint64_t max_memory = 6ull << 30;
  std::filesystem::path cache_folder;   ///< empty: no disk caches
  KernelTiming timing = KernelTiming::none;
};

/// Milliseconds by step since the session began (start-up, script, compile) and of the last frame (upload, execute, read-back).
struct SessionTimes {
  double device = 0, script = 0, compile = 0;
  FrameTimes frame;
};

struct SessionReport {
  std::string device, driver, preset;
  std::string storage;            ///< "fp32" or "fp16"
  bool reference = false, hardware_filter = false;
  double max_error = 2e-3;
  std::vector<Skipped> skipped;   ///< effects and passes that did not run, with reasons
  std::vector<std::string> kernels;
  ProgramMemory memory;
  SessionTimes times;
};

/// Not thread-safe.
class Session {
 public:
  /// Loads the preset and opens the device. Errors: script, device, usage (unknown override).
  static Result<std::unique_ptr<Session>> open(const std::filesystem::path& preset, const SessionOptions& options, Diagnostics& diagnostics);
  ~Session();

  Preset& preset();
  Device& device();
  /// The graph for a picture of this size with these auxiliary inputs.
  Result<Graph> graph(const BuildContext& context);
  /// Bytes of host and device memory that a picture of this size needs, at most.
  Result<std::uint64_t> memory_needed(const BuildContext& context);
  /// Runs the stack; `picture.color` is replaced by the result (alpha kept).
  Result<void> process(Picture& picture, const BuildContext& context);
  SessionReport report() const;

 private:
  struct State;
  explicit Session(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace afterglow
