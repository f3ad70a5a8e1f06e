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

enum class OutputKind { exr, hdr, png, jpeg, tiff };

struct OutputFormat {
  OutputKind kind;
  const char* name;                     ///< OpenImageIO's
  std::vector<std::string> extensions;  ///< with the dot, lower case
  std::vector<SampleType> types;
  std::vector<std::string> compressions;  ///< empty: no choice
  bool alpha;
};

/// Errors: usage (unknown extension; the sample type or compression is not one of the format's).
Result<const OutputFormat*> output_format(const std::filesystem::path& file, const WriteOptions& options);

/// The type that `options.type` comes to for this format; `facts` of the input may be null.
SampleType sample_type(const OutputFormat& format, const WriteOptions& options, const FileFacts* facts);

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
