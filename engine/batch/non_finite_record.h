// SPDX-License-Identifier: MIT
// What a run says about values that are not finite: each cause once, and the sums at the end.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "session/trace.h"

namespace afterglow {

/// Of one frame. Places: from the upper left corner of the display window where an image covers the picture (also
/// before --size for those of the input), else pixels of the pass's image.
struct FrameNonFinite {
  std::map<std::string, NonFinite> input;  ///< by layer
  std::vector<PassFinding> passes;         ///< in their order
  std::vector<PassOverflow> overflows;     ///< of a frame that half floats could not hold, in their order
  bool untraced = false;                   ///< something was not finite, but nothing is when every pass runs by itself
};

/// The passes of a trace, with their places in the picture.
void take_findings(FrameNonFinite& frame, const Trace& trace, const Picture& picture);
/// Of --nan-policy fail. Names pass, shader, counts and pixel.
Error non_finite_error(const PassFinding& finding, const std::filesystem::path& input);

/// Over all frames. Not thread-safe.
class NonFiniteRecord {
 public:
  void add(const FrameNonFinite& frame);
  /// Warns about passes that were not warned about before.
  void tell(const FrameNonFinite& frame, const std::filesystem::path& input, NanPolicy policy,
            Diagnostics& diagnostics) const;
  /// The same about passes that made more than half floats hold.
  void tell_overflows(const FrameNonFinite& frame, const std::filesystem::path& input, Diagnostics& diagnostics) const;
  /// One warning with the counts of all frames, when there was anything.
  void sum_up(Diagnostics& diagnostics) const;

 private:
  std::map<std::string, std::uint64_t> samples_;  ///< by source: "input color", "pass glow.down[2]"
  std::size_t frames_ = 0, of_ = 0;
};

}  // namespace afterglow
