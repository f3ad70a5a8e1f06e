// SPDX-License-Identifier: MIT
// A decoded frame as RGB: matrix, range and places of chroma by zimg, which is what FFmpeg's zscale is made of.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>

#include "core/geometry.h"
#include "core/result.h"
#include "image/ffmpeg_handles.h"

namespace afterglow {

/// What of a frame's samples is told nowhere is filled in.
struct FramePlanes {
  AVPixelFormat format = AV_PIX_FMT_NONE;
  Size stored, wanted;  ///< `wanted`: scaled to, for pixels that are not square
  int matrix = 1;       ///< of H.273
  int transfer = 1;     ///< of H.273; for matrices that depend on it
  int primaries = 1;    ///< the same
  bool full_range = false;
  int chroma_place = 1;  ///< AVChromaLocation
  bool operator==(const FramePlanes&) const = default;
};

/// Thread-safe; keeps what zimg prepared for the last kind of frame.
class FfmpegPlanes {
 public:
  FfmpegPlanes();
  ~FfmpegPlanes();
  /// Stored values of RGB, A where the format has it, as MovieSource::read says. Errors: io (a pixel format that is not
  /// read, "is …").
  Result<void> convert(const AVFrame& frame, const FramePlanes& planes, float* rgba, std::size_t row_stride);

 private:
  struct Graphs;
  Result<std::shared_ptr<const Graphs>> graphs(const FramePlanes& planes);
  std::mutex mutex_;
  std::shared_ptr<const Graphs> graphs_;
};

/// Whether frames of this format can be converted.
bool is_readable_format(AVPixelFormat format);

}  // namespace afterglow
