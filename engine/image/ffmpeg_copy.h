// SPDX-License-Identifier: MIT
// Sound, subtitles, attachments, chapters and texts of one file go into another as they are, packet by packet;
// subtitles and sound that the other cannot hold as they are become what it can.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "core/result.h"
#include "image/ffmpeg_bytes.h"
#include "image/ffmpeg_clock.h"
#include "image/ffmpeg_handles.h"
#include "image/ffmpeg_output.h"
#include "image/ffmpeg_sound_encoder.h"
#include "image/ffmpeg_subtitles.h"
#include "image/video_output.h"

namespace afterglow {

/// `sound`: no subtitles, chapters and texts.
enum class Copied { all, sound, all_but_sound };

/// Not thread-safe. Errors: io (also: no bytes come), interrupted (nobody waits for them any more).
class FfmpegCopy {
 public:
  /// Adds to `output` a stream for each of `file` that it can hold; others are named in a warning. `encodes`: sound
  /// that it cannot hold is encoded anew, which is told; else it is left out.
  static Result<std::unique_ptr<FfmpegCopy>> open(const std::filesystem::path& file, Copied what, bool encodes,
                                                  FfmpegOutput& output, const CopyRange& range,
                                                  const Patience& patience, const std::string& name,
                                                  Diagnostics& diagnostics);
  ~FfmpegCopy();

  /// Of the first picture in the file; empty: it has none.
  std::string time_code() const;
  /// What its pictures are marked as, their language and title.
  void describe_pictures(AVStream& to) const;
  /// Writes what comes before `until` (microseconds of the output's clock).
  Result<void> copy(std::int64_t until);
  /// What encoders still hold, once.
  Result<void> finish();

 private:
  explicit FfmpegCopy(FfmpegOutput& output) : output_(output) {}
  void follow_clock(Copied what, const Patience& patience);
  Result<AVStream*> add_stream(unsigned index);
  void cut_sound();
  Result<void> add_streams(Copied what, const std::string& name, Diagnostics& diagnostics);
  void add_chapters();
  std::int64_t begin_of(AVPacket& packet, std::int64_t stamp) const;
  Result<bool> wait_for_next();
  Result<void> put(AVPacket& packet);
  Result<void> wait(std::size_t stream, std::int64_t next, std::int64_t until) const;
  Result<void> write(AVPacket& packet, std::size_t stream) const;
  FfmpegSoundEncoder::Put put_sound(std::size_t stream) const;
  Error cannot_be_read(int code) const;

  FfmpegOutput& output_;
  std::filesystem::path file_;
  std::unique_ptr<FfmpegBytes> bytes_;
  AVFormatContext* input_ = nullptr;
  std::vector<int> target_;                              ///< of each stream; −1: none
  std::vector<std::unique_ptr<FfmpegSubtitles>> texts_;  ///< of streams that become others
  std::vector<std::unique_ptr<FfmpegSoundEncoder>> sounds_;
  PacketHandle waiting_;  ///< read, and later than the last `until`
  CopyRange range_;
  std::optional<ClockFollower> clock_;
  std::int64_t late_ = 0;  ///< so much of encoded sound comes before what is its beginning
  bool encodes_ = false, ended_ = false;
};

}  // namespace afterglow
