// SPDX-License-Identifier: MIT
// Clocks that start anew within a file (clock_part.h): found by the pictures' stamps, followed by those of the sound.
#pragma once

#include <vector>

#include "image/clock_part.h"
#include "image/ffmpeg_index.h"

namespace afterglow {

inline constexpr AVRational kMicroseconds{1, AV_TIME_BASE};

/// Transport and program streams, whose clocks run from anywhere.
bool is_mpeg(const AVFormatContext& container);

/// Whether an MPEG stream's clock starts anew between these stamps of decoding, of which either may be unknown.
bool starts_anew(std::int64_t last, std::int64_t next, AVRational time_base);

/// Puts the parts of the file behind one another. Pictures that show before the first key of a part are not shown, as
/// at the beginning of a file that was cut. Returns no part where there is but one.
std::vector<ClockPart> run_on(const AVFormatContext& container, AVRational time_base,
                              std::vector<MoviePacket>& packets);

/// The same for the packets of all other streams, in the order in which they are read. Where there are no parts, sound
/// whose stamps go back goes on behind what came before it. `alone`: there are no pictures that tell of the clock; then
/// sound that pauses for long goes on at once, too.
class ClockFollower {
 public:
  ClockFollower(std::vector<ClockPart> parts, unsigned streams, bool alone = false)
      : parts_(std::move(parts)), ways_(streams), alone_(alone) {}
  /// False: the packet lies over what came before it, and is to be left out.
  bool follow(AVPacket& packet, const AVStream& stream);
  /// What is read next follows this place, to which the stream had come then (microseconds of the clock that runs on).
  void resume(int stream, std::int64_t pos, std::int64_t time);

 private:
  static constexpr std::int64_t kNone = AV_NOPTS_VALUE;
  /// How far a stream has come. Times in microseconds.
  struct Way {
    std::int64_t pos = 0, begin = kNone, end = kNone, shift = 0;  ///< of its last packet
  };
  std::int64_t shift_of(const Way& way, std::int64_t time, bool sound) const;
  std::int64_t shift_by_itself(const Way& way, std::int64_t time) const;

  std::vector<ClockPart> parts_;
  std::vector<Way> ways_;  ///< by stream
  bool alone_ = false;
};

}  // namespace afterglow
