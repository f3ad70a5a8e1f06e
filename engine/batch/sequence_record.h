// SPDX-License-Identifier: MIT
// What frames of a sequence have otherwise than the rest of it: inputs that they lack (without depth the fog of one
// frame would be gone) and overscan; and which channels each took.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "batch/run_events.h"
#include "batch/run_report.h"
#include "image/reader.h"
#include "script/build.h"

namespace afterglow {

/// What frames of a sequence lack of an input.
struct SequenceInput {
  std::vector<int> without, failed;                ///< that were made all the same, and that were not
  std::string effect;                              ///< that the first of them lacks it for; empty: none is skipped
  std::optional<std::filesystem::path> elsewhere;  ///< a frame that has it
  bool looked = false;
};
using SequenceInputs = std::map<std::string, SequenceInput>;

/// Pixels around the display window: left, top, right, bottom.
using Overscan = std::array<int, 4>;
using SequenceOverscan = std::map<Overscan, std::vector<int>>;  ///< with the numbers of their frames

/// Used from one thread. Sequences are files whose names differ in a number alone; frames of videos are none.
class SequenceRecord {
 public:
  /// Inputs that a frame's header tells of; none where it cannot be read.
  using Inputs = std::function<std::vector<std::string>(const FrameJob&)>;
  explicit SequenceRecord(Diagnostics& diagnostics) : diagnostics_(&diagnostics) {}
  /// `frames`: all of the run; they outlive it.
  void know(const FrameRecords& frames, Inputs inputs);

  /// Notes a frame that has been planned; `wanted`: the inputs that its look may ask for. Effects that are skipped for
  /// lack of an input are warned about where no other frame has it. An error (io), to be told by `sum_up`: others have
  /// it, and their entries do not say that they can do without (`required = false`).
  std::optional<Error> add(FrameRecord& frame, const PictureHeader& header, const std::vector<std::string>& wanted,
                           const Build& build);
  /// Tells of the frames that failed so, that were made without an input which others have, and whose overscan is
  /// another: each in one message. Forgets them.
  /// `whole`: all frames are done; of some alone nobody knows what is usual.
  void sum_up(const RunEvents& events, bool whole);

 private:
  struct Sequence {
    SequenceInputs inputs;
    SequenceOverscan overscan;
  };
  bool is_elsewhere(const FrameJob& job, const std::string& name, SequenceInput& input) const;
  void warn_skipped(const Skipped& skipped) const;
  std::optional<Error> add_input(const FrameJob& job, const std::string& name, SequenceInput& input,
                                 const Build& build) const;

  Diagnostics* diagnostics_;
  const FrameRecords* frames_ = nullptr;
  Inputs inputs_;
  std::map<std::string, Sequence> sequences_;
  SharedChannels taken_;  ///< of the frame that was added last
};

}  // namespace afterglow
