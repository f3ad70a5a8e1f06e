// SPDX-License-Identifier: MIT
// What can be written: formats by extension, their sample types and compressions.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "image/writer.h"

namespace afterglow {

struct FileFacts;

enum class OutputKind { exr, hdr, png, jpeg, tiff, dpx, cineon, targa, webp, jpeg2000, ppm, pam, pfm };

struct OutputFormat {
  OutputKind kind;
  const char* name;                     ///< OpenImageIO's, where it writes them
  std::vector<std::string> extensions;  ///< with the dot, lower case
  std::vector<SampleType> types;
  std::vector<std::string> compressions;  ///< empty: no choice
  bool alpha;
  const char* space = nullptr;  ///< of its integers, by the name of input_space.h; null: sRGB
};

/// Errors: usage (unknown extension; the sample type, the space or the compression is not one of the format's).
Result<const OutputFormat*> output_format(const std::filesystem::path& file, const WriteOptions& options);

/// That the file's extension is none of those that are known.
Error unknown_format(const std::filesystem::path& file, const std::vector<std::string>& known);

/// The type that `options.type` comes to for this format; `facts` of the input may be null.
SampleType sample_type(const OutputFormat& format, const WriteOptions& options, const FileFacts* facts);

bool is_integer(SampleType type);
/// The largest code of an integer type.
int max_code(SampleType type);

/// The space that samples of this type are stored in; null: sRGB for integers, scene-linear light for floats.
const OutputSpace* stored_space(const OutputFormat& format, const WriteOptions& options, SampleType type);

/// Is noise put between the codes of this type?
inline bool dithers(const WriteOptions& options, SampleType type) {
  return options.dither.value_or(type == SampleType::uint8);
}

/// "dwaa:45" → name "dwaa", level 45 (−1 without one). Errors: usage (the level is no number).
struct Compression {
  std::string name;
  float level = -1;
};
Result<Compression> parse_compression(const std::string& text);

}  // namespace afterglow
