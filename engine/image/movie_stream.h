// SPDX-License-Identifier: MIT
// Pictures that come on standard input: frames one after the other, of which nobody knows how many, or one file.
#pragma once

#include <atomic>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "core/result.h"
#include "image/memory_file.h"
#include "image/movie.h"

namespace afterglow {

/// Frames that were never in a file. Errors name the input "-".
class MovieStream {
 public:
  /// `raw`: "1920x1080:rgb48le:24", the last part may be missing; else the bytes say what they are (Y4M, NUT, Matroska,
  /// MPEG transport streams, PPM, PGM, PAM, PFM). `head`: bytes that were read already. Errors: usage (`raw`), io.
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
