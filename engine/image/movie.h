// SPDX-License-Identifier: MIT
// A video file, frame by frame. What Debian's OpenImageIO reads through FFmpeg: MP4, QuickTime and AVI; Matroska and
// WebM are refused by it, and MPEG streams would keep it busy for ever.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>

#include "core/diagnostics.h"
#include "core/result.h"
#include "image/color_encoding.h"
#include "image/layers.h"
#include "image/picture.h"
#include "image/picture_file.h"

namespace afterglow {

/// What a file's first bytes say. `unreadable_movie`: a container that is known and that nobody here reads.
enum class MovieContainer { none, movie, unreadable_movie };
/// Files that cannot be opened are none. `name`, when given: what the container is called.
MovieContainer movie_container(const std::filesystem::path& file, const char** name = nullptr);

/// Thread-safe: one frame is read at a time. Frames in order are cheap; others make the decoder look for a key frame.
class Movie {
 public:
  /// Errors: io (no video that can be read, with what can be done about it; sides beyond the limits).
  static Result<std::unique_ptr<Movie>> open(const std::filesystem::path& file, const SizeLimits& limits,
                                             Diagnostics& diagnostics);

  int frames() const { return frames_; }
  double fps() const { return fps_; }  ///< frames a second; 0: the file does not say
  Size size() const;
  /// `frame` counts from 0. Errors: io (beyond the end, damaged).
  Result<Picture> read(int frame);

 private:
  Movie() = default;
  std::mutex mutex_;
  std::unique_ptr<PictureFile> file_;
  ChannelChoice color_;
  ColorEncoding encoding_;
  std::shared_ptr<const FileFacts> facts_;
  int frames_ = 0;
  double fps_ = 0;
};

}  // namespace afterglow
