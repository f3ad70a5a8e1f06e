// SPDX-License-Identifier: MIT
// Clocks that start anew within a file (clock_part.h): found by the pictures' stamps, followed by those of the sound.
#pragma once

#include <vector>

#include "image/clock_part.h"
#include "image/ffmpeg_index.h"

namespace afterglow {

/// Puts the parts of the file behind one another. Pictures that show before the first key of a part are not shown, as
/// at the beginning of a file that was cut. Returns no part where there is but one.
std::vector<ClockPart> run_on(const AVFormatContext& container, AVRational time_base,
                              std::vector<MoviePacket>& packets);

/// The same for the packets of all other streams, in the order in which they are read.
class ClockFollower {
 public:
  ClockFollower(std::vector<ClockPart> parts, unsigned streams) : parts_(std::move(parts)), ends_(streams, kNone) {}
  /// False: the packet lies over what came before it, and is to be left out.
  bool follow(AVPacket& packet, const AVStream& stream);

 private:
  static constexpr std::int64_t kNone = AV_NOPTS_VALUE;
  std::int64_t shift_of(const AVPacket& packet, std::int64_t time, std::int64_t end) const;

  std::vector<ClockPart> parts_;
  std::vector<std::int64_t> ends_;  ///< by stream: until when it has come, in microseconds
};

}  // namespace afterglow
