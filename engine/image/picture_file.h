// SPDX-License-Identifier: MIT
// One open picture file, whatever its format: parts and channels by name, samples as stored. Behind it are OpenEXR for
// .exr, FFmpeg for frames of videos and OpenImageIO for everything else.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "core/result.h"
#include "image/color_encoding.h"
#include "image/layers.h"
#include "image/metadata.h"
#include "image/size_limits.h"

namespace afterglow {

/// Where a channel's samples go: sample (x, y), counted from the corner of the part's data window, to base[y·row_stride
/// + x·pixel_stride].
struct ReadTarget {
  int channel = 0;
  float* base = nullptr;
  std::size_t pixel_stride = 1, row_stride = 0;  ///< in floats
};

/// Rows [begin, end) of all targets are whole. Called once for each row, from several threads.
using RowsArrived = std::function<void(int begin, int end)>;

/// Not thread-safe. Errors: io, naming the file.
class PictureFile {
 public:
  virtual ~PictureFile() = default;

  const std::filesystem::path& path() const { return path_; }
  const std::string& format() const { return format_; }  ///< OpenImageIO's name of it
  const std::vector<FilePart>& parts() const { return parts_; }

  /// Memory for decoding this part, besides the targets.
  virtual std::uint64_t buffer_bytes(int part) const = 0;
  /// All rows of the part; each channel at most once. Integers are scaled to 0…1, except those of EXR, which are plain
  /// numbers. A file that ends too early is an error, though some rows may have been written. `rows`, if given, is told
  /// of rows as they come, while they lie in the processor's caches.
  Result<void> read(int part, std::span<const ReadTarget> targets, const RowsArrived& rows = {});
  /// Colours whose channels are all stored as half floats, as RGBA without gaps, a row after the other from the data
  /// window's top; an alpha that is not there is 1. False: the file does not hold them so, and nothing was read.
  virtual Result<bool> read_halves([[maybe_unused]] const ChannelChoice& color, [[maybe_unused]] std::uint16_t* rgba,
                                   [[maybe_unused]] const RowsArrived& rows) {
    return false;
  }
  /// How the chosen colour channels are encoded. `warnings` that matter to users are passed on.
  virtual ColorEncoding color_encoding(const ChannelChoice& color, Diagnostics& diagnostics) const = 0;
  /// What a writer keeps, for these colour channels.
  virtual FileFacts facts(const ChannelChoice& color) const = 0;

 protected:
  /// Whether it called `rows`; else they are told of when all are read.
  virtual Result<bool> read_targets(int part, std::span<const ReadTarget> targets, const RowsArrived& rows) = 0;
  Error failed(const std::string& why) const { return Error{ErrorKind::io, why, path_.string()}; }

  std::filesystem::path path_;
  std::string format_;
  std::vector<FilePart> parts_;
};

/// Opens by content, not by extension. Reads the header only. `limits` are checked before a library sees the file where
/// that is possible (EXR, PNG, JPEG), else right after it has read the header.
Result<std::unique_ptr<PictureFile>> open_picture(const std::filesystem::path& file, const SizeLimits& limits);

}  // namespace afterglow
