// SPDX-License-Identifier: MIT
// A video file, frame by frame: any frame by number is the one that a decode from the beginning shows. And pictures
// that come on standard input: frames one after the other, of which nobody knows how many, or one file.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/diagnostics.h"
#include "core/result.h"
#include "image/memory_file.h"
#include "image/movie_container.h"
#include "image/movie_source.h"
#include "image/picture_file.h"
#include "image/sound.h"

namespace afterglow {

struct ContainerFacts;  // image/container_check.h

/// Thread-safe. Frames in order are cheap; others are decoded from the key frame before them.
class Movie {
 public:
  /// Reads the file once, for an index of its frames. Notes what is assumed where it says nothing, warns of what is
  /// damaged or missing. Errors: io (no video that can be read, with what can be done about it; sides beyond the
  /// limits; no bytes come, see core/patience.h), interrupted (give_up_waiting), usage (AFTERGLOW_INPUT_TIMEOUT).
  /// `checked`: what the file's own head says, where somebody has looked at it already.
  static Result<std::shared_ptr<Movie>> open(const std::filesystem::path& file, const SizeLimits& limits,
                                             Diagnostics& diagnostics, const ContainerFacts* checked = nullptr);

  /// Of frames that somebody has already; `name` stands for a file.
  static std::shared_ptr<Movie> of(const std::filesystem::path& name, std::shared_ptr<MovieSource> source);

  const std::filesystem::path& file() const { return file_; }
  const MovieFacts& facts() const { return source_->facts(); }
  /// Those that are missing at the end of a truncated file too: reading them is an error.
  int frames() const { return static_cast<int>(facts().pts.size()); }
  double fps() const;  ///< frames a second, on the average; 0: the file does not say
  /// Frames do not come at one rate.
  bool variable_rate() const;
  /// The rate at which they come, where that is one but for roundings of the stamps; none of a stream.
  std::optional<Rational> even_rate() const { return even_rate_; }
  /// When the frame shows, in seconds from the first one.
  double time(int frame) const;
  /// The frame as a picture file, for the reader; it keeps the movie open.
  static std::unique_ptr<PictureFile> frame(std::shared_ptr<Movie> movie, int frame);

 private:
  Movie() = default;
  std::filesystem::path file_;
  std::shared_ptr<MovieSource> source_;
  std::optional<Rational> even_rate_;
  std::shared_ptr<const ContainerFacts> container_;  ///< of a PNG or WebP that moves: no decoder tells its colours
  friend class MovieFrameFile;
};

/// Frames that were never in a file. Errors name the input "-".
class MovieStream {
 public:
  /// `raw`: "1920x1080:rgb48le:24", the last part may be missing; else the bytes say what they are (Y4M, NUT, Matroska,
  /// MPEG transport streams, PPM, PGM, PAM, PFM, several JPEGs). `head`: bytes that were read already. Errors: usage
  /// (`raw`), io.
  static Result<std::unique_ptr<MovieStream>> open(std::shared_ptr<FileDescriptor> from, std::string head,
                                                   const std::string& raw, const SizeLimits& limits,
                                                   Diagnostics& diagnostics);
  /// What is being read is given up.
  ~MovieStream();

  struct Frame {
    std::shared_ptr<Movie> movie;  ///< of this frame alone; null: there is no more
    double time = 0;               ///< seconds from the first one
  };
  /// Waits for the next frame; the one behind it is decoded meanwhile. Errors: io (it ends within a frame, damaged).
  Result<Frame> next();
  double fps() const;  ///< 0: unknown

 private:
  MovieStream() = default;
  void begin_next();
  struct State;
  std::unique_ptr<State> state_;
};

/// What standard input turned out to be.
struct StandardInput {
  std::unique_ptr<MovieStream> stream;     ///< frames, or
  std::shared_ptr<const MemoryFile> file;  ///< one file: a picture, or a video that has to be sought in
};
/// Looks at the first bytes; a file is read to its end. Errors: as those of MovieStream::open, io (nothing comes, more
/// than `limits` allow).
Result<StandardInput> open_standard_input(const std::string& raw, const SizeLimits& limits, Diagnostics& diagnostics);

}  // namespace afterglow
