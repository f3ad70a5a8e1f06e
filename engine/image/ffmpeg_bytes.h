// SPDX-License-Identifier: MIT
// The bytes of one file for FFmpeg's demuxers, read with patience: what gives none is given up, and with it everything
// that waits for it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/file_descriptor.h"
#include "core/patient_reader.h"
#include "core/result.h"
#include "image/container_end.h"
#include "image/ffmpeg_handles.h"

namespace afterglow {

/// Not thread-safe. Outlives the container that reads it.
class FfmpegBytes {
 public:
  /// Errors: io (the file cannot be opened).
  static Result<std::unique_ptr<FfmpegBytes>> open(const std::filesystem::path& file, const Patience& patience);
  /// Of a descriptor that cannot seek. `head` comes first; `most`: bytes between two packets.
  FfmpegBytes(std::unique_ptr<PatientReader> reader, std::string head, std::uint64_t most);
  ~FfmpegBytes();
  FfmpegBytes(const FfmpegBytes&) = delete;
  FfmpegBytes& operator=(const FfmpegBytes&) = delete;

  /// A container that reads from here alone, to be opened with this demuxer's format; no other file is opened by it.
  /// Null: no memory.
  AVFormatContext* container();
  /// A packet has come: the bytes up to the next are counted anew.
  void packet_came() { spent_ = 0; }
  /// Why there is no use in reading on, when that is so: no bytes come, nobody waits for them any more, or the demuxer
  /// reads on and on and finds no packet. It stays so. Without a file.
  const std::optional<Error>& given_up() const { return given_up_; }
  /// Whether it is known where they end: of what cannot seek, when that has come.
  bool end_is_known() const { return seekable_ || at_end_; }
  /// What has been read, to look at it again; used before this object goes.
  PlacedBytes again();

 private:
  static int read(void* opaque, std::uint8_t* to, int size);
  static std::int64_t seek(void* opaque, std::int64_t to, int whence);

  void note(const std::uint8_t* bytes, std::size_t count);
  std::string_view look(std::uint64_t at, std::size_t count);

  std::unique_ptr<PatientReader> reader_;
  bool seekable_ = false;
  std::string head_;
  std::size_t given_ = 0;    ///< of the head
  std::uint64_t spent_ = 0;  ///< read since the last packet
  std::uint64_t most_ = 0;   ///< of them
  bool at_end_ = false;
  std::uint64_t all_ = 0;     ///< bytes that were handed out, of what cannot seek
  std::string first_, last_;  ///< of them, some
  std::string window_;        ///< of a file, what was looked at last
  std::uint64_t window_at_ = 0;
  std::optional<Error> given_up_;
  AVIOContext* io_ = nullptr;
};

}  // namespace afterglow
