// SPDX-License-Identifier: MIT
// A video file, frame by frame: any frame by number is the one that a decode from the beginning shows.
#pragma once

#include <filesystem>
#include <memory>

#include "core/diagnostics.h"
#include "core/result.h"
#include "image/movie_container.h"
#include "image/movie_source.h"
#include "image/picture_file.h"

namespace afterglow {

/// Thread-safe. Frames in order are cheap; others are decoded from the key frame before them.
class Movie {
 public:
  /// Reads the file once, for an index of its frames. Notes what is assumed where it says nothing, warns of what is
  /// damaged or missing. Errors: io (no video that can be read, with what can be done about it; sides beyond the
  /// limits).
  static Result<std::shared_ptr<Movie>> open(const std::filesystem::path& file, const SizeLimits& limits,
                                             Diagnostics& diagnostics);

  /// Of frames that somebody has already; `name` stands for a file.
  static std::shared_ptr<Movie> of(const std::filesystem::path& name, std::shared_ptr<MovieSource> source);

  const std::filesystem::path& file() const { return file_; }
  const MovieFacts& facts() const { return source_->facts(); }
  /// Those that are missing at the end of a truncated file too: reading them is an error.
  int frames() const { return static_cast<int>(facts().pts.size()); }
  double fps() const;  ///< frames a second, on the average; 0: the file does not say
  /// Frames do not come at one rate.
  bool variable_rate() const;
  /// When the frame shows, in seconds from the first one.
  double time(int frame) const;
  /// The frame as a picture file, for the reader; it keeps the movie open.
  static std::unique_ptr<PictureFile> frame(std::shared_ptr<Movie> movie, int frame);

 private:
  Movie() = default;
  std::filesystem::path file_;
  std::shared_ptr<MovieSource> source_;
  friend class MovieFrameFile;
};

}  // namespace afterglow
