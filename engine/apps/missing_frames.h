// SPDX-License-Identifier: MIT
// Frames of a sequence that are not there, as one message.
#pragma once

#include <functional>
#include <optional>

#include "core/result.h"

namespace afterglow {

/// Passes errors on. Of files that are not there and whose numbers follow each other at one step, a single error is
/// made: when another comes, a frame that is there, or the end. Not thread-safe.
class MissingFrames {
 public:
  explicit MissingFrames(std::function<void(const Error&)> tell) : tell_(std::move(tell)) {}
  ~MissingFrames();
  MissingFrames(const MissingFrames&) = delete;
  MissingFrames& operator=(const MissingFrames&) = delete;

  void add(const Error& error);
  /// The run comes to the next frame.
  void next();

 private:
  bool continues(const std::string& file, int number) const;
  void tell_kept();

  std::function<void(const Error&)> tell_;
  std::optional<Error> first_;
  std::string last_;  ///< file
  int count_ = 0, number_ = 0, step_ = 0;
  bool added_ = false;  ///< since the run came to its frame
};

}  // namespace afterglow
