// SPDX-License-Identifier: MIT
// What a file says about its picture besides the pixels, independent of format and library. Names are OpenImageIO's
// ("Copyright", "ImageDescription", "Exif:FNumber"), which are close to those of TIFF and Exif.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

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

}  // namespace afterglow
