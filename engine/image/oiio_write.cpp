// SPDX-License-Identifier: MIT
#include "image/oiio_write.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/exception.h"
#include "core/text.h"
#include "image/icc_profile.h"
#include "image/jpeg_iptc.h"
#include "image/memory_file.h"
#include "image/metadata.h"
#include "image/oiio_metadata.h"
#include "image/output_metadata.h"
#include "image/output_space.h"
#include "image/rgbe.h"
#include "image/strips.h"
#include "image/write_webp.h"

namespace afterglow {
namespace {

constexpr int kRows = 64;         // a strip
constexpr int kTiffZipLevel = 2;  // zlib; OpenImageIO takes 6, three times slower for a few per cent

/// An OutputFile as OpenImageIO wants to see it.
class OiioOutput : public OIIO::Filesystem::IOProxy {
 public:
  OiioOutput(OutputFile& file, const std::string& name) : IOProxy(name, Write), file_(file) {}
  const char* proxytype() const override { return "afterglow"; }
  int64_t tell() override { return static_cast<int64_t>(file_.position()); }
  bool seek(int64_t offset) override {
    if (offset < 0) return false;
    file_.seek(static_cast<std::uint64_t>(offset));
    return true;
  }
  size_t write(const void* data, size_t size) override { return file_.write(data, size) ? size : 0; }
  size_t read(void* data, size_t size) override { return file_.read(data, size) ? size : 0; }
  size_t size() const override { return file_.size(); }
  void flush() const override { file_.flush(); }

 private:
  OutputFile& file_;
};

/// A JPEG comes in one piece.
class JpegOutput : public OiioOutput {
 public:
  using OiioOutput::OiioOutput;
  size_t write(const void* data, size_t size) override {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    std::vector<std::uint8_t> jpeg(bytes, bytes + size);
    tell_iptc_letters(jpeg);
    return OiioOutput::write(jpeg.data(), jpeg.size()) == jpeg.size() ? size : 0;
  }
};

/// Codes of 10 and 12 bits as OpenImageIO wants them: of 16, the upper bits once more below.
void widen(SampleType type, std::uint8_t* bytes, std::size_t samples) {
  const int bits = type == SampleType::uint10 ? 10 : type == SampleType::uint12 ? 12 : 16;
  if (bits == 16 || type == SampleType::uint8) return;
  auto* codes = reinterpret_cast<std::uint16_t*>(bytes);
  for (std::size_t i = 0; i < samples; ++i)
    codes[i] = static_cast<std::uint16_t>(codes[i] << (16 - bits) | codes[i] >> (2 * bits - 16));
}

OIIO::TypeDesc oiio_type(SampleType type) {
  switch (type) {
    case SampleType::half:
      return OIIO::TypeHalf;
    case SampleType::float32:
      return OIIO::TypeFloat;
    case SampleType::uint10:
    case SampleType::uint12:
    case SampleType::uint16:
      return OIIO::TypeUInt16;
    default:
      return OIIO::TypeUInt8;
  }
}

/// What the file is to say of its colours. Spaces that it has no word for are not told.
void describe_color(OIIO::ImageSpec& spec, const StripForm& form, const FileFacts* facts) {
  const std::string_view space = form.space ? form.space->name() : "srgb";
  if (!is_integer(form.type) || space == "linear") {
    spec.attribute("oiio:ColorSpace", "Linear");
    return;
  }
  if (form.view) return;
  if (space == "cineon") spec.attribute("oiio:ColorSpace", "KodakLog");
  if (space != "srgb") return;
  spec.attribute("oiio:ColorSpace", "sRGB");
  if (!facts || !facts->had_profile) return;
  const std::vector<std::uint8_t> profile = srgb_icc_profile();
  if (!profile.empty())
    spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(profile.size())),
                   profile.data());
}

/// DPX has words for these; it would take an old file's else.
const char* film_transfer(const StripForm& form) {
  const std::string_view space = form.space ? form.space->name() : "srgb";
  return space == "linear"   ? "Linear"
         : space == "cineon" ? "Logarithmic"
         : space == "rec709" ? "ITU-R 709-4"
                             : "User defined";
}

/// With a unit the two resolutions say the shape of a pixel. Without one they say it alone: JPEG's are its width and
/// height then, TIFF's dots across and down.
void describe_shape(OIIO::ImageSpec& spec, bool widths) {
  constexpr float kDots = 72, kMost = 100;
  const std::string unit = lower(spec.get_string_attribute("ResolutionUnit"));
  const float ratio = spec.get_float_attribute("PixelAspectRatio", 1);
  if (unit.starts_with("in") || unit.starts_with("cm") || unit == "m") {
    if (widths) spec.erase_attribute("PixelAspectRatio");  // of which the library would make another resolution
    return;
  }
  if (ratio == 1) return;
  if (!(ratio > 1 / kMost && ratio < kMost)) return;
  spec.attribute("XResolution", std::round(widths ? kDots * ratio : kDots));
  spec.attribute("YResolution", std::round(widths ? kDots : kDots * ratio));
  spec.attribute("ResolutionUnit", "none");
}

/// The library's EXIF has no unit, which means inches.
void use_inches(OIIO::ImageSpec& spec) {
  constexpr float kInch = 2.54f;
  if (!lower(spec.get_string_attribute("ResolutionUnit")).starts_with("cm")) return;
  for (const char* name : {"XResolution", "YResolution"})
    if (const float dots = spec.get_float_attribute(name); dots > 0) spec.attribute(name, dots * kInch);
  spec.attribute("ResolutionUnit", "in");
}

Result<OIIO::ImageSpec> spec_for(const Picture& picture, const OutputFormat& format, const StripForm& form,
                                 const WriteOptions& options) {
  OIIO::ImageSpec spec(picture.display_window.width, picture.display_window.height, form.alpha ? 4 : 3,
                       oiio_type(form.type));
  if (picture.facts) spec.extra_attribs = param_list(kept_metadata(*picture.facts));
  describe_color(spec, form, picture.facts.get());
  if (form.alpha) {
    spec.alpha_channel = 3;
    if (is_integer(form.type)) spec.attribute("oiio:UnassociatedAlpha", 1);
  }
  AFTERGLOW_TRY(const Compression compression, parse_compression(options.compression));
  switch (format.kind) {
    case OutputKind::dpx:
      spec.attribute("dpx:Transfer", film_transfer(form));
      spec.attribute("oiio:BitsPerSample", std::bit_width(static_cast<unsigned>(max_code(form.type))));
      break;
    case OutputKind::targa:
      spec.attribute("compression", compression.name.empty() ? "rle" : compression.name);
      break;
    case OutputKind::jpeg:
      spec.attribute("CompressionQuality", std::clamp(options.jpeg_quality.value_or(95), 1, 100));
      spec.attribute("jpeg:subsampling", "4:4:4");
      use_inches(spec);
      describe_shape(spec, true);
      break;
    case OutputKind::tiff:
      // The time of the writing would make other bytes of the same picture: "unknown", as Exif writes it.
      if (spec.get_string_attribute("DateTime").empty()) spec.attribute("DateTime", "    :  :     :  :  ");
      spec.attribute("compression", options.compression.empty() ? "zip" : lower(options.compression));
      spec.attribute("tiff:zipquality", kTiffZipLevel);
      if (form.type == SampleType::half) spec.attribute("tiff:half", 1);  // else floats are written
      describe_shape(spec, false);
      break;
    default:
      break;
  }
  return spec;
}

Error library_failed(OIIO::ImageOutput& output) {
  const std::string why = trim(output.geterror());
  return Error{ErrorKind::io, why.empty() ? "cannot be written" : "cannot be written: " + why};
}

/// Reads every row of a file that was written without OutputFile to see to it.
Result<void> read_back(const std::string& name) {
  const auto input = OIIO::ImageInput::open(name);
  if (!input) return Error{ErrorKind::io, "cannot be written: reading it back failed: " + trim(OIIO::geterror())};
  const OIIO::ImageSpec spec = input->spec();
  std::vector<std::uint8_t> rows(spec.scanline_bytes() * kRows);
  static_cast<void>(input->geterror());
  for (int y = 0; y < spec.height; y += kRows) {
    const bool read = input->read_scanlines(0, 0, y, std::min(y + kRows, spec.height), 0, 0, spec.nchannels,
                                            spec.format, rows.data());
    const std::string why = trim(input->geterror());  // may be all that it says
    if (!read || !why.empty()) return Error{ErrorKind::io, "cannot be written: reading it back failed: " + why};
  }
  return {};
}

/// Five halvings of the sides are what OpenImageIO asks OpenJPEG for.
Result<void> check_jpeg2000(Size size) {
  constexpr int kLeast = 32;
  if (size.width >= kLeast && size.height >= kLeast) return {};
  return Error{ErrorKind::io,
               fmt::format("cannot be written: JPEG 2000 files have sides of at least {} pixels, not {}x{}", kLeast,
                           size.width, size.height)};
}

/// Writes to `name`, or to `proxy` where there is one.
Result<void> write_rows(const Picture& picture, const OutputFormat& format, const std::string& name, OiioOutput* proxy,
                        const WriteOptions& options) {
  const StripForm form = strip_form(picture, format, options);
  AFTERGLOW_TRY(const OIIO::ImageSpec spec, spec_for(picture, format, form, options));
  const auto output = OIIO::ImageOutput::create(format.name);
  if (!output) return Error{ErrorKind::io, fmt::format("cannot be written: OpenImageIO has no {} writer", format.name)};
  if (proxy) output->set_ioproxy(proxy);
  if (!output->open(name, spec)) return library_failed(*output);
  std::vector<std::uint8_t> strip(form.row_bytes(picture) * kRows);
  for (int y = 0; y < spec.height; y += kRows) {
    const int rows = std::min(kRows, spec.height - y);
    encode_strip(picture, form, y, rows, strip.data());
    widen(form.type, strip.data(), form.row_bytes(picture) * static_cast<std::size_t>(rows) / form.sample_bytes());
    if (format.kind == OutputKind::hdr)
      round_to_rgbe(std::span(reinterpret_cast<float*>(strip.data()),
                              static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(rows) * 3));
    if (!output->write_scanlines(y, y + rows, 0, oiio_type(form.type), strip.data())) return library_failed(*output);
  }
  const bool closed = output->close();
  // A JPEG 2000 that fails here returns true; a TIFF that is well says that Exif data failed.
  if (!closed || (format.kind == OutputKind::jpeg2000 && output->has_error())) return library_failed(*output);
  return {};
}

/// Lossless, or with the quality of "lossy:N".
Result<void> write_webp(const Picture& picture, const OutputFormat& format, OutputFile& out,
                        const WriteOptions& options) {
  constexpr float kQuality = 90;
  AFTERGLOW_TRY(const Compression compression, parse_compression(options.compression));
  std::optional<float> quality;
  if (compression.name == "lossy") quality = compression.level < 0 ? kQuality : compression.level;
  OIIO::ImageSpec said;
  if (picture.facts) said.extra_attribs = param_list(kept_metadata(*picture.facts));
  use_inches(said);
  return write_webp(picture, strip_form(picture, format, options), out, quality, exif_of(said.extra_attribs));
}

/// libtiff opens its file itself: OpenImageIO 2.4 cannot look back at a TIFF that goes through a proxy, and then
/// damages it where Exif data is to be written. A disk that fails may crash libtiff, or go unnoticed.
Result<void> write_through_memory(const Picture& picture, const OutputFormat& format, OutputFile& out,
                                  const WriteOptions& options) {
  AFTERGLOW_TRY(const MemoryFile file, MemoryFile::create());
  AFTERGLOW_CHECK(write_rows(picture, format, file.name(), nullptr, options));
  AFTERGLOW_CHECK(read_back(file.name()));
  return file.copy_to(out);
}

}  // namespace

Result<void> write_with_oiio(const Picture& picture, const OutputFormat& format, OutputFile& out,
                             const std::string& name, const WriteOptions& options) {
  try {
    if (format.kind == OutputKind::tiff) return write_through_memory(picture, format, out, options);
    if (format.kind == OutputKind::webp) return write_webp(picture, format, out, options);
    if (format.kind == OutputKind::jpeg2000) AFTERGLOW_CHECK(check_jpeg2000(picture.display_window.size()));
    OiioOutput plain(out, name);
    JpegOutput jpeg(out, name);
    return write_rows(picture, format, name, format.kind == OutputKind::jpeg ? &jpeg : &plain, options);
  } catch (const std::exception& error) {
    return Error{ErrorKind::io, fmt::format("cannot be written: {}", exception_text(error))};
  }
}

}  // namespace afterglow
