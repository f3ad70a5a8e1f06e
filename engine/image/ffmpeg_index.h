// SPDX-License-Identifier: MIT
// All packets of a video stream, by one pass over the file: which frames there are, in which order they show, and
// from which packet each can be decoded.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/result.h"
#include "image/clock_part.h"
#include "image/ffmpeg_input.h"

namespace afterglow {

struct MoviePacket {
  std::int64_t pts = 0, dts = 0, pos = 0;
  std::int64_t shift = 0;  ///< what was added to the stamps in the file (ClockPart)
  int size = 0;
  std::int64_t duration = 0;  ///< as the container says, or FFmpeg guesses; 0: neither
  bool key = false;           ///< decoding can begin here
  bool exact = false;         ///< and what follows is right from here on; else from the next key packet on
  bool shown = true;          ///< it makes a frame that shows
  bool damaged = false;       ///< the file itself says so, or ends in it
  bool needless = false;      ///< no other frame is made of it
};

/// A stream that was cut begins with pictures that nobody can decode.
void hide_what_comes_before_the_first_key(std::span<MoviePacket> packets);

struct MovieIndex {
  std::vector<MoviePacket> packets;  ///< in the order in which they are decoded
  std::vector<int> order;            ///< packet of each frame, in the order in which they show
  std::vector<int> rank;             ///< frame of each packet; −1: none
  std::vector<long long> pts;        ///< of each frame, and of those that are missing
  std::vector<int> keys;             ///< packets at which decoding can begin
  long long last_length = 0;         ///< how long the last frame shows, where the container says so; else 0
  std::size_t missing = 0;           ///< frames at the end that the file tells of and does not hold
  std::vector<ClockPart> parts;      ///< where the file's clock starts anew; empty: it does not

  /// Where decoding has to begin so that this packet's frame comes out whole: in a closed group of pictures its key
  /// packet; pictures that show before their key packet need the one before.
  int start_for(int packet) const;
};

/// Reads the file to its end. Errors: io (more than a million frames, nothing in it).
Result<MovieIndex> index_movie(FfmpegInput& input);

/// Adds frames at the end that are not there, at the pace of those that are.
void add_missing(MovieIndex& index, std::size_t missing);

/// Sets `order`, `rank` and `pts` by the packets' time stamps.
void sort_by_time(MovieIndex& index);

}  // namespace afterglow
