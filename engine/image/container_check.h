// SPDX-License-Identifier: MIT
// What files say about themselves, read before a library does: sizes that are lies, files that end too
// early (JPEG decoders invent the missing half), and PNG's colour chunks, which OpenImageIO does not pass on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/geometry.h"
#include "core/result.h"
#include "image/color_matrix.h"
#include "image/deep_pnm.h"

namespace afterglow {

struct ContainerFacts {
  enum class Kind { other, exr, png, jpeg } kind = Kind::other;
  std::optional<Size> size;                 ///< where it can be told before a library opens the file
  std::uint64_t least_file_bytes = 0;       ///< fewer cannot hold the pixels, however well they compress
  std::uint64_t decoder_bytes = 0;          ///< what the decoder keeps of the whole picture (interlaced, progressive)
  bool fourth_is_padding = false;           ///< BMP, Targa: the fourth byte of a pixel means nothing
  std::optional<DeepPnm> deep_pnm;          ///< PNM with another largest value than 255
  std::uint32_t line_padding = 0;           ///< DPX: bytes behind each line that its header does not tell of
  double exposure = 1;                      ///< Radiance: what the light was multiplied by
  std::optional<int> orientation;           ///< Radiance, WebP, PNG: as Exif has it, where the library may not find it
  int deeper_bits = 0;                      ///< HEIF, AVIF: of a sample, where they are more than the 8 that are read
  bool srgb = false;                        ///< PNG sRGB chunk
  bool adobe_rgb = false;                   ///< EXIF of a JPEG says so
  std::optional<double> gamma;              ///< PNG gAMA: the exponent that encoded, e.g. 0.45455
  std::optional<Chromaticities> primaries;  ///< PNG cHRM
  /// PNG cICP, nclx of HEIF and AVIF: numbers of ITU-T H.273.
  struct Codes {
    int primaries = 2, transfer = 2;
    bool limited = false;  ///< samples have the range of video
  };
  std::optional<Codes> codes;
  std::vector<std::uint8_t> exif;     ///< WebP, whose reader skips its first bytes
  std::vector<std::uint8_t> profile;  ///< ICC, where the reader may not pass it on: PNG, WebP, HEIF and AVIF
};

/// Errors: io (missing, folder, no regular file, empty, unreadable; PNG, JPEG or DPX that is malformed or ends too
/// early).
Result<ContainerFacts> check_container(const std::filesystem::path& file);

}  // namespace afterglow
