// SPDX-License-Identifier: MIT
// Frames of a sequence through one stack, as a session runs them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness.h"
#include "session/session.h"

namespace afterglow {

class TemporalPlayer {
 public:
  /// `entries`: Lua, as `run_stack` takes it. `reference`: every pass on its own.
  explicit TemporalPlayer(const std::string& entries, bool reference = false,
                          Precision precision = Precision::automatic);
  ~TemporalPlayer();
  TemporalPlayer(const TemporalPlayer&) = delete;
  TemporalPlayer& operator=(const TemporalPlayer&) = delete;

  /// RGBA in, RGBA out.
  std::vector<float> play(std::vector<float> pixels, Size size, int frame, double fps = 24);
  std::vector<float> play(const reference::DoubleImage& source, int frame, double fps = 24);
  /// With what it holds besides colour.
  std::vector<float> play(const Scene& scene, int frame, double fps = 24);

 private:
  std::vector<float> process(Picture picture, int frame, double fps);

  Diagnostics diagnostics_;
  std::unique_ptr<Session> session_;
};

}  // namespace afterglow
