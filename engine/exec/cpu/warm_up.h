// SPDX-License-Identifier: MIT
// Drivers of CPU devices compile a kernel when something is first drawn with it: in the middle of a frame, on the
// thread that waits for it. Here a pixel is drawn with each kernel before, on a device of its own, where nobody waits.
// The driver's cache on disk hands what it has compiled to the device that plays.
#pragma once

#include <memory>

#include "exec/program.h"

namespace afterglow {

/// One thread at a time.
class WarmUp {
 public:
  /// Whether drawing on another device saves the first frame on `device` anything: its driver compiles late and has a
  /// cache on disk that is not turned off.
  static bool helps(const Device& device);
  /// Opens the same device once more. Errors: device.
  static Result<std::unique_ptr<WarmUp>> create(const Device& device, bool validate = false);
  ~WarmUp();

  /// A pixel of each kernel of a program for `graph`; those that the last one had too are not compiled again.
  /// `options`: as the program that plays is made. Errors: those of Program::create.
  Result<void> draw(ShaderLibrary& shaders, KernelCompiler& compiler, const Graph& graph, ProgramOptions options);
  int validation_errors() const;

 private:
  struct State;
  explicit WarmUp(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace afterglow
