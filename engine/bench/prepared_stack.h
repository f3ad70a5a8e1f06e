// SPDX-License-Identifier: MIT
// A preset made ready to be measured under one choice of execution.
#pragma once

#include <memory>
#include <optional>

#include "bench/results.h"
#include "bench/turns.h"
#include "exec/timing.h"
#include "session/stack.h"

namespace afterglow::bench {

/// What to measure.
struct Variant {
  std::string label;                      ///< "plain16f"
  std::optional<ExecutionConfig> choice;  ///< empty: as `run` would choose
  std::string settings;                   ///< for reports: what `overrides` add to the preset
  std::vector<Override> overrides;
  bool check_finite = false;                ///< values that are not finite are looked for, as `run` does
  std::optional<DisplayEncoding> encoding;  ///< the last kernel writes 8-bit codes; not for `try_out`
};

class PreparedStack {
 public:
  /// Runs the script and makes the program. `base` says everything but the choice and the variant's overrides. Errors:
  /// script, usage, device, io.
  static Result<PreparedStack> create(Device& device, const std::filesystem::path& preset, const StackOptions& base,
                                      const Variant& variant, const Picture& picture, Diagnostics& diagnostics);
  PreparedStack() = default;

  /// Runs it on the picture as frames of `run` are; `rgb` gets R, G and B of the result. With `passes`, times each
  /// kernel too (median of a few runs). Fills all of a Point that can be known before measuring in turns.
  Result<Point> try_out(Device& device, const Picture& picture, bool passes, std::vector<float>& rgb);

  /// Records it on the device's picture, which must outlive it. Errors: device.
  Result<void> record(const Device& device, const DevicePicture& picture);
  TimedWork& work() { return work_; }

  Stack& stack() { return *stack_; }
  bool runs() const { return stack_->runs(); }
  /// What it must be recorded on.
  PictureKind picture_kind() const;

 private:
  Variant variant_;
  std::unique_ptr<Stack> stack_;
  TimedWork work_;
};

/// The picture's size and auxiliary inputs, for `build`.
BuildContext context_of(const Picture& picture);

}  // namespace afterglow::bench
