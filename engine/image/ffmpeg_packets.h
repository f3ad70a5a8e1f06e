// SPDX-License-Identifier: MIT
// The packets of an indexed stream, from any of them on. Where a container's own seeking goes wrong the packets are
// counted from the beginning: slow, never wrong.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "image/ffmpeg_index.h"

namespace afterglow {

/// Not thread-safe.
class FfmpegPackets {
 public:
  using Reopen = std::function<Result<std::unique_ptr<FfmpegInput>>()>;
  /// `input` has been read to its end; `reopen` opens it anew.
  FfmpegPackets(std::unique_ptr<FfmpegInput> input, const MovieIndex& index, Reopen reopen);

  FfmpegInput& input() { return *input_; }
  /// The packet that `read` gives next.
  int position() const { return next_; }
  bool at_end() const { return next_ >= static_cast<int>(index_.packets.size()); }
  /// So that `read` gives this packet next. Errors: io.
  Result<void> seek(int packet);
  /// The next packet, with its place in the index as its time stamp: what comes out of a decoder is known by it.
  /// Errors: io (the file is another one than when it was indexed).
  Result<void> read(AVPacket& packet);

 private:
  bool try_seek(std::int64_t stamp, int packet);
  Result<void> begin_anew(int packet);
  int find(const AVPacket& packet) const;
  bool take(AVPacket& packet);
  Error not_there() const;

  std::unique_ptr<FfmpegInput> input_;
  const MovieIndex& index_;
  Reopen reopen_;
  std::vector<int> by_place_;  ///< packets sorted by position and time stamp
  PacketHandle held_;          ///< the packet `next_`, when it was read already
  bool holds_ = false;
  int next_ = 0;
  std::optional<Error> given_up_;  ///< it stays so: not every frame waits for bytes that do not come
};

}  // namespace afterglow
