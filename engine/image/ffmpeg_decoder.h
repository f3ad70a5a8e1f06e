// SPDX-License-Identifier: MIT
// Frames of an indexed stream by number. The decoder goes on from where it stands, or begins anew at a packet from
// which the frame comes out as it would in a decode from the beginning.
#pragma once

#include <deque>
#include <memory>
#include <set>
#include <vector>

#include "image/ffmpeg_packets.h"

namespace afterglow {

/// Not thread-safe.
class FfmpegDecoder {
 public:
  /// Decoded frames of up to `cache_bytes` are kept: going backwards decodes each group of pictures once.
  FfmpegDecoder(FfmpegPackets packets, const MovieIndex& index, std::uint64_t cache_bytes);

  FfmpegInput& input() { return packets_.input(); }
  /// Errors: io (damaged, built on what is damaged).
  Result<FrameHandle> frame(int number);
  /// The order in which frames come out of a decode from the beginning, as packets, each once: for streams without time
  /// stamps.
  Result<std::vector<int>> order_by_decoding();

 private:
  struct Cached {
    int packet = 0;
    std::uint64_t bytes = 0;
    FrameHandle frame;
  };
  const AVFrame* cached(int packet) const;
  Result<void> begin_at(int packet, bool careful = false);
  void forget();
  Result<bool> step();
  Result<void> decode_until(int packet, int start);
  void keep(FrameHandle frame, int packet);
  void note_complaints();
  void note_lost(int from, int to);
  Result<void> check_whole(int packet, int start) const;
  int last_needed(int packet, int start) const;

  FfmpegPackets packets_;
  const MovieIndex& index_;
  std::uint64_t cache_bytes_, held_bytes_ = 0;
  std::unique_ptr<FfmpegErrors> errors_ = std::make_unique<FfmpegErrors>(0);
  CodecHandle codec_;
  bool careful_ = false;     ///< decoding on one thread
  bool intra_only_ = false;  ///< no frame is built on another
  PacketHandle packet_;
  std::deque<Cached> cache_;   ///< the newest at the back
  std::set<int> damaged_;      ///< packets, as far as it is known
  std::set<int> complained_;   ///< packets of these that their decoder told of
  std::vector<bool> settled_;  ///< by packet: it is known what came of it and of all that it is built on
  int start_ = -1;             ///< packet at which decoding began; −1: it has not
  int emitted_ = -1;           ///< frame that came out last
  int came_last_ = -1;         ///< its packet
  bool draining_ = false, ended_ = false;
};

}  // namespace afterglow
