// SPDX-License-Identifier: MIT
// What a file says about its picture besides the pixels, independent of format and library. Names are OpenImageIO's
// ("Copyright", "ImageDescription", "Exif:FNumber"), which are close to those of TIFF and Exif.
#pragma once

#include <OpenEXR/ImfForward.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "image/color_matrix.h"

namespace afterglow {

struct Rational {
  int numerator = 0, denominator = 1;
};
/// Vectors of 2, 3 or 16 floats (a matrix).
using MetadataValue = std::variant<std::string, int, float, Rational, std::vector<float>>;

struct MetadataEntry {
  std::string name;
  MetadataValue value;
};
using Metadata = std::vector<MetadataEntry>;

/// Null when there is none.
const MetadataValue* find_metadata(const Metadata& metadata, std::string_view name);
/// As a number, or `otherwise` when it is none.
float metadata_number(const MetadataValue& value, float otherwise);
/// As text: numbers are printed.
std::string metadata_text(const MetadataValue& value);

/// The camera's place in the scene, from EXR's `worldToCamera` (row vectors: camera = world · M). Empty when there is
/// none, or when the matrix is not finite or flattens space.
std::optional<std::array<double, 3>> camera_position(const Metadata& metadata);

/// What is remembered of a picture's file for the writer.
struct FileFacts {
  std::filesystem::path file;
  std::string format;           ///< OpenImageIO's name of it: "openexr", "png", …
  int bits = 8;                 ///< of a colour sample
  bool floating = false;        ///< half or float samples
  bool yuv = false;             ///< codes of a video, some of which lie beyond black and white
  bool keeps_negative = false;  ///< ReadOptions::keep_negative
  bool had_profile = false;     ///< an ICC profile was embedded
  bool had_chromaticities = false;
  /// Of the file where layers come from that this one has not; empty: there is none.
  std::filesystem::path mattes;
  Metadata matte_metadata;
  /// Of linear colours as an EXR stores them; none: Rec.709, or as if.
  std::optional<Chromaticities> primaries;
  int orientation = 1;
  /// How many times as wide, for their height, pixels have become since (`--size` of another shape).
  double widened = 1;
  int part = 0;  ///< of the colour
  std::array<std::string, 4>
      color_channels{};  ///< names in the file of R, G, B, A; grey has the same three; A may be empty
  Metadata metadata;     ///< everything the file said
  std::shared_ptr<const Imf::Header> exr_header;  ///< of the colour's part, when the file was EXR
};

}  // namespace afterglow
