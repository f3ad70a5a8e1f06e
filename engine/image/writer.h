// SPDX-License-Identifier: MIT
// Writes results whole or not at all. The format is chosen by the extension. Thread-safe. Errors: io, usage (bad option
// text).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "core/result.h"
#include "image/output_space.h"
#include "image/picture.h"

namespace afterglow {

/// Memory of files that are done, for those that come. Holds no more blocks than were in use at a time. Thread-safe.
class WorkMemory {
 public:
  struct Block {
    std::unique_ptr<std::uint8_t[]> bytes;
    std::size_t size = 0;
  };
  /// At least so many bytes; they may be anything.
  Block take(std::size_t size);
  void give(Block block);

 private:
  std::mutex mutex_;
  std::vector<Block> free_;
};

enum class SampleType { automatic, half, float32, uint8, uint10, uint12, uint16 };

/// Of videos and streams; empty: what suits the output (video_output.h).
struct VideoOptions {
  std::string codec;            ///< "h264", …
  std::string pixel_format;     ///< "yuv420p10le", …
  std::string bitrate;          ///< "8M"
  std::optional<int> crf;       ///< quality, 0 is best
  std::filesystem::path audio;  ///< sound of another file
  bool piece = false;           ///< frames alone, without what other files have: for join_video
};

struct WriteOptions {
  /// automatic: EXR half unless the input was float, HDR and PFM float, DPX and Cineon uint10, display formats uint8
  /// (uint16 when the input had integers of more than 8 bits and the format can). Float TIFF is scene-linear.
  SampleType type = SampleType::automatic;
  /// Of integer samples; null: that of the format (DPX, Cineon: printing density, others sRGB).
  const OutputSpace* space = nullptr;
  /// Empty: ZIP for EXR, the format's default elsewhere. EXR: none rle zip zips piz pxr24 b44 b44a dwaa dwab, some with
  /// ":level"; TIFF: none lzw zip packbits; WebP: lossless, lossy:quality; Targa: none rle.
  std::string compression;
  std::optional<int> png_level = {};     ///< 0–9, 1 where it is not said; see image/deflate.h
  std::optional<int> jpeg_quality = {};  ///< 1–100, 95 where it is not said
  /// Blue noise between two integer codes; deterministic. Empty: into 8 bits, not into 16.
  std::optional<bool> dither = {};
  int dither_x = 0, dither_y = 0;  ///< where the picture's upper left pixel lies in the noise (≥ 0)
  VideoOptions video{};
  WorkMemory* memory = nullptr;  ///< used by `write_picture` for what it makes of a picture; null: made anew
  bool keep_layers = false;      ///< EXR → EXR: copy all other channels and parts of `picture.facts`' file unchanged
};

/// Scene formats (EXR, HDR, PFM) get scene-linear values and, for EXR, both windows; all others get the display window,
/// clamped and encoded in their space. Alpha is written when the picture has it and the format can; straight where the
/// format wants it.
/// `stamp`, when given, gets file_stamp of what was written.
Result<void> write_picture(const Picture& picture, const std::filesystem::path& file, const WriteOptions& options,
                           Diagnostics& diagnostics, std::string* stamp = nullptr);

/// Memory that `write_picture` takes besides a picture of this size, at most. 0 where it is a few rows,
/// or not known. `facts` may be null.
std::uint64_t write_bytes(const std::filesystem::path& file, const WriteOptions& options, Size size, bool has_alpha,
                          const FileFacts* facts);

/// The bytes that a file of this extension ("png") would have. Errors: as write_picture.
Result<std::string> picture_bytes(const Picture& picture, const std::string& extension, const WriteOptions& options,
                                  Diagnostics& diagnostics);

/// Whether dropping alpha changes what is seen.
bool has_transparency(const Picture& picture);

/// How `write_picture` will make 8-bit display codes for `file`, so that another can make them (Picture::unorm8).
struct DisplayCodes {
  bool straight_alpha = false;
  bool dither = false;
  friend bool operator==(const DisplayCodes&, const DisplayCodes&) = default;
};
/// Nothing when it will write anything else. `has_alpha` and `facts` are the picture's; `facts` may be null.
std::optional<DisplayCodes> display_codes(const std::filesystem::path& file, const WriteOptions& options,
                                          bool has_alpha, const FileFacts* facts);

/// Checks, without writing, that `file` has an extension we write and that its folder exists and can be written, and
/// what is in its place, too. For errors before the work.
Result<void> check_output(const std::filesystem::path& file, const WriteOptions& options);
/// What some format takes as WriteOptions::compression, without levels.
std::vector<std::string> compression_names();
/// Of pictures, with the dot.
std::vector<std::string> picture_extensions();
/// Whether pictures or videos have such an extension. Errors: usage.
Result<void> check_extension(const std::filesystem::path& file);
/// The format of a picture alone. Errors: usage.
Result<void> check_format(const std::filesystem::path& file, const WriteOptions& options);
/// The same of the folder alone.
Result<void> check_place(const std::filesystem::path& file);

}  // namespace afterglow
