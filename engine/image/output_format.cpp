// SPDX-License-Identifier: MIT
#include "image/output_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "core/parse_number.h"
#include "core/text.h"
#include "image/metadata.h"
#include "image/output_space.h"

namespace afterglow {
namespace {

const std::vector<OutputFormat>& formats() {
  using enum SampleType;
  static const std::vector<OutputFormat> all{
      {OutputKind::exr,
       "openexr",
       {".exr"},
       {half, float32},
       {"none", "rle", "zip", "zips", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"},
       true},
      {OutputKind::hdr, "hdr", {".hdr"}, {float32}, {}, false},
      {OutputKind::png, "png", {".png"}, {uint8, uint16}, {}, true},
      {OutputKind::jpeg, "jpeg", {".jpg", ".jpeg"}, {uint8}, {}, false},
      {OutputKind::tiff,
       "tiff",
       {".tif", ".tiff"},
       {uint8, uint16, half, float32},
       {"none", "lzw", "zip", "packbits"},
       true},
      {OutputKind::dpx, "dpx", {".dpx"}, {uint8, uint10, uint12, uint16}, {}, true, "cineon"},
      {OutputKind::cineon, "", {".cin"}, {uint10}, {}, false, "cineon"},
      {OutputKind::targa, "targa", {".tga"}, {uint8}, {"none", "rle"}, true},
      {OutputKind::webp, "webp", {".webp"}, {uint8}, {"lossless", "lossy"}, true},
      {OutputKind::jpeg2000, "jpeg2000", {".jp2", ".j2k"}, {uint8, uint16}, {}, true},
      {OutputKind::ppm, "", {".ppm", ".pnm"}, {uint8, uint16}, {}, false},
      {OutputKind::pam, "", {".pam"}, {uint8, uint16}, {}, true},
      {OutputKind::pfm, "", {".pfm"}, {float32}, {}, false},
  };
  return all;
}

const char* type_name(SampleType type) {
  switch (type) {
    case SampleType::half:
      return "half";
    case SampleType::float32:
      return "float";
    case SampleType::uint8:
      return "uint8";
    case SampleType::uint10:
      return "uint10";
    case SampleType::uint12:
      return "uint12";
    case SampleType::uint16:
      return "uint16";
    default:
      return "auto";
  }
}

const OutputFormat* find_format(const std::filesystem::path& file) {
  const auto is_of = [extension = lower(file.extension().string())](const OutputFormat& format) {
    return std::ranges::find(format.extensions, extension) != format.extensions.end();
  };
  const auto found = std::ranges::find_if(formats(), is_of);
  return found == formats().end() ? nullptr : &*found;
}

/// The largest level of methods that take one: EXR's a zlib level, or the error that DWA allows; WebP's a quality.
std::optional<float> largest_level(const OutputFormat& format, const std::string& name) {
  if (format.kind == OutputKind::webp && name == "lossy") return 100.0f;
  if (format.kind != OutputKind::exr) return {};
  if (name == "zip" || name == "zips") return 9.0f;
  if (name == "dwaa" || name == "dwab") return 1e5f;
  return {};
}

}  // namespace

Result<Compression> parse_compression(const std::string& text) {
  const std::size_t colon = text.find(':');
  Compression result{lower(text.substr(0, colon)), -1};
  if (colon == std::string::npos) return result;
  const std::string level = text.substr(colon + 1);
  const auto number = parse_number<float>(level);
  if (!number || !(*number >= 0) || !(*number <= 1e5f))
    return Error{ErrorKind::usage, fmt::format("the compression level '{}' is not a number of at least 0", level)};
  result.level = *number;
  return result;
}

std::vector<std::string> picture_extensions() {
  std::vector<std::string> names;
  for (const OutputFormat& format : formats())
    names.insert(names.end(), format.extensions.begin(), format.extensions.end());
  return names;
}

std::vector<std::string> compression_names() {
  std::vector<std::string> names;
  for (const OutputFormat& format : formats())
    for (const auto& name : format.compressions)
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  return names;
}

Error unknown_format(const std::filesystem::path& file, const std::vector<std::string>& known) {
  const std::string extension = lower(file.extension().string());
  // A name without a point: a folder that is to be made, more likely than a picture.
  const std::string folder =
      extension.empty() ? fmt::format("; a folder is written {}/", file.string()) : std::string();
  return {ErrorKind::usage,
          extension.empty() ? "has no extension that tells its format"
                            : fmt::format("'{}' is not a format that is written", extension),
          file.string(),
          0,
          join(known) + folder,
          nearest_name(extension, known)};
}

namespace {

/// EXR alone says what primaries its light has.
Result<void> check_linear_space(const OutputFormat& format, const WriteOptions& options,
                                const std::filesystem::path& file) {
  const std::string name = format.extensions[0].substr(1);
  if (format.kind != OutputKind::exr)
    return Error{ErrorKind::usage,
                 fmt::format("{} files hold scene-linear light; --output-space is for integer samples and EXR", name),
                 file.string()};
  std::vector<std::string> linear;
  for (const InputSpace& space : input_spaces())
    if (space.linear()) linear.emplace_back(space.name);
  if (!options.space->linear())
    return Error{ErrorKind::usage, fmt::format("{} files hold scene-linear light, not {}", name, options.space->name()),
                 file.string(), 0, join(linear)};
  if (options.keep_layers)
    return Error{ErrorKind::usage,
                 "--keep-layers writes colours in the primaries of the layers beside them, not in an "
                 "--output-space",
                 file.string()};
  return {};
}

}  // namespace

Result<const OutputFormat*> output_format(const std::filesystem::path& file, const WriteOptions& options) {
  const OutputFormat* const found = find_format(file);
  if (!found) return unknown_format(file, picture_extensions());
  if (options.type != SampleType::automatic &&
      std::find(found->types.begin(), found->types.end(), options.type) == found->types.end()) {
    std::vector<std::string> names;
    for (const SampleType type : found->types) names.emplace_back(type_name(type));
    return Error{
        ErrorKind::usage,
        fmt::format("{} files cannot hold samples of type {}", found->extensions[0].substr(1), type_name(options.type)),
        file.string(), 0, join(names)};
  }
  if (options.space && !is_integer(sample_type(*found, options, nullptr)))
    AFTERGLOW_CHECK(check_linear_space(*found, options, file));
  if (options.keep_layers && found->kind != OutputKind::exr)
    return Error{ErrorKind::usage, "only EXR files can keep layers", file.string(), 0, ".exr"};
  if (options.png_level && found->kind != OutputKind::png)
    return Error{ErrorKind::usage, "--png-level is for PNG files", file.string(), 0, ".png"};
  if (options.jpeg_quality && found->kind != OutputKind::jpeg)
    return Error{ErrorKind::usage, "--jpeg-quality is for JPEG files", file.string(), 0, ".jpg"};
  if (options.compression.empty()) return found;
  AFTERGLOW_TRY(const Compression compression, parse_compression(options.compression));
  if (found->compressions.empty())
    return Error{ErrorKind::usage,
                 fmt::format("{} files have no choice of compression", found->extensions[0].substr(1)), file.string()};
  if (std::find(found->compressions.begin(), found->compressions.end(), compression.name) == found->compressions.end())
    return Error{ErrorKind::usage,          fmt::format("unknown compression '{}'", compression.name), file.string(), 0,
                 join(found->compressions), nearest_name(compression.name, found->compressions)};
  if (compression.level < 0) return found;
  const auto largest = largest_level(*found, compression.name);
  if (!largest)
    return Error{ErrorKind::usage, fmt::format("compression '{}' takes no level", compression.name), file.string()};
  if (compression.level > *largest)
    return Error{ErrorKind::usage,
                 fmt::format("compression '{}' has no level {:g}", compression.name, compression.level), file.string(),
                 0, fmt::format("0 to {:g}", *largest)};
  return found;
}

SampleType sample_type(const OutputFormat& format, const WriteOptions& options, const FileFacts* facts) {
  if (options.type != SampleType::automatic) return options.type;
  switch (format.kind) {
    case OutputKind::exr:
      return facts && facts->floating && facts->bits > 16 ? SampleType::float32 : SampleType::half;
    case OutputKind::hdr:
    case OutputKind::pfm:
      return SampleType::float32;
    case OutputKind::dpx:
    case OutputKind::cineon:
      return SampleType::uint10;
    case OutputKind::jpeg:
    case OutputKind::targa:
    case OutputKind::webp:
      return SampleType::uint8;
    default:
      return facts && !facts->floating && facts->bits > 8 ? SampleType::uint16 : SampleType::uint8;
  }
}

bool is_integer(SampleType type) {
  using enum SampleType;
  return type == uint8 || type == uint10 || type == uint12 || type == uint16;
}

int max_code(SampleType type) {
  switch (type) {
    case SampleType::uint8:
      return 255;
    case SampleType::uint10:
      return 1023;
    case SampleType::uint12:
      return 4095;
    default:
      return 65535;
  }
}

const OutputSpace* stored_space(const OutputFormat& format, const WriteOptions& options, SampleType type) {
  if (!is_integer(type)) return nullptr;
  const OutputSpace* space = options.space;
  if (!space && format.space) space = find_output_space(format.space).value();
  return space && std::string_view(space->name()) == "srgb" ? nullptr : space;
}

}  // namespace afterglow
