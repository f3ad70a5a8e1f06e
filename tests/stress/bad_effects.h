// SPDX-License-Identifier: MIT
// Effects that break what they promise, each in one way, and a device to catch them with.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "stress/check.h"
#include "stress/trial.h"

namespace afterglow::stress {

/// A folder with effects of a test's own, gone afterwards.
class EffectFolder {
 public:
  EffectFolder();
  ~EffectFolder();
  EffectFolder(const EffectFolder&) = delete;
  EffectFolder& operator=(const EffectFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

  /// An effect of one pass, with the settings `strength` (0…1, 0.5) and `level` (0…10, 1) and `more` lines of Lua.
  /// `glsl` defines apply or sample_at and may use the uniforms strength and level; lines in `pass` go into the g:pass
  /// call.
  void effect(const std::string& name, const std::string& glsl, const std::string& more = "",
              const std::string& pass = "") const;
  void write(const std::string& file, const std::string& text) const;
  /// Only that effect, at its defaults.
  Look look(const std::string& effect) const;

 private:
  std::filesystem::path path_;
};

/// The lavapipe device of this process with its harness; the validation layer is on.
Harness& harness();
/// Errors that the validation layer has seen so far.
int validation_errors();

/// A picture as trials have it.
Situation situation(const Look& look, const std::string& check, const PictureSpec& picture, std::uint64_t seed = 7);

/// The outcome; fails the test when the check cannot run.
Outcome outcome_of(const Situation& situation);

}  // namespace afterglow::stress
