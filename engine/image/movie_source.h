// SPDX-License-Identifier: MIT
// What a reader of videos tells of one, and how it hands out frames: between movie.h and the module that decodes.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/file_descriptor.h"
#include "core/geometry.h"
#include "core/patience.h"
#include "core/result.h"
#include "image/clock_part.h"
#include "image/metadata.h"
#include "image/size_limits.h"

namespace afterglow {

/// Bytes of decoded frames that a movie keeps at most, of those that pictures may take (ReadOptions::max_bytes).
inline std::uint64_t movie_cache_bytes(std::uint64_t max_bytes) {
  constexpr std::uint64_t kMost = 256ull << 20;
  return std::min(kMost, max_bytes / 8);
}

/// Numbers as in ITU-T H.273; 2: the file does not say.
struct MovieColor {
  int primaries = 2, transfer = 2, matrix = 2;
  bool full_range = false;
  bool rgb = false;      ///< stored as RGB or as codes of a palette
  bool picture = false;  ///< of a codec of still pictures: MJPEG, GIF, PNG
};

struct MovieFacts {
  std::string container;     ///< "matroska", "mov", FFmpeg's names
  std::string codec;         ///< "h264"
  std::string pixel_format;  ///< "yuv420p10le"
  Size stored;               ///< of the frames in the file
  Size size;                 ///< of the frames that are handed out: square pixels, not turned yet
  Rational pixel_aspect{1, 1};
  int orientation = 1;  ///< 1…8 as in Exif: how to turn the frames
  double turned = 0;    ///< degrees that no orientation can say; not applied
  bool has_alpha = false;
  bool grey = false;
  bool floating = false;
  int bits = 8;  ///< of a sample
  bool interlaced = false;
  bool pictures_alone = false;  ///< the file has room for nothing else
  bool sound = false;           ///< of what cannot be sought in: there is sound beside the pictures
  bool hdr_metadata = false;    ///< it says which display it was made on, or how bright it gets (HDR10)
  MovieColor color;
  Rational rate{0, 1};           ///< frames a second, on the average; 0: unknown
  Rational time_base{1, 1};      ///< seconds of a time stamp's unit
  std::vector<long long> pts;    ///< of each frame that the file has or ought to have, in the order in which they show
  std::vector<ClockPart> clock;  ///< where the file's clock starts anew, while `pts` runs on; empty: it does not
  long long last_length = 0;     ///< how long the last frame shows, in the same unit; 0: the file does not say
  std::size_t missing = 0;       ///< so many at the end are not there: the file is shorter than it says
  std::string time_code;         ///< of the first frame, "01:02:03:04" (kept_values.h); empty: none
  bool leaves_alpha = false;     ///< an alpha that is not read
  std::vector<std::string> notes;     ///< what people may want to know
  std::vector<std::string> warnings;  ///< what makes its colours doubtful
};

/// Thread-safe.
class MovieSource {
 public:
  virtual ~MovieSource() = default;
  const MovieFacts& facts() const { return facts_; }
  /// Stored values, integers scaled to 0…1 (and beyond, where the codes leave room): RGB, and A where there is alpha,
  /// to rgba[y·row_stride + x·4 + channel]. Grey is written to all three. Errors: io (damaged; the message follows
  /// "frame N").
  virtual Result<void> read(int frame, float* rgba, std::size_t row_stride) = 0;

 protected:
  MovieFacts facts_;
};

/// What is to be opened. `format`: FFmpeg's name of the container; no other is tried.
struct MovieRequest {
  std::filesystem::path file;
  std::string format;
  SizeLimits limits;
  Patience patience{};
};

/// Frames as they come; from one thread at a time.
class MovieFrames {
 public:
  virtual ~MovieFrames() = default;
  /// The next frame, as a source of that frame alone; null at the end. Errors: io (damaged, cut off).
  virtual Result<std::shared_ptr<MovieSource>> next() = 0;
};

/// What cannot be sought in. `head`: bytes that were read from it already; `options`: the demuxer's own, as
/// "name=value:name=value"; `cancelled`: waiting for bytes ends when it is true. It outlives the stream.
struct StreamRequest {
  std::shared_ptr<FileDescriptor> from;
  std::string head;
  std::string name;  ///< for messages
  std::string format;
  std::string options;
  SizeLimits limits;
  Patience patience{};
  const std::atomic<bool>* cancelled = nullptr;
};

}  // namespace afterglow
