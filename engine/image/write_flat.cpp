#include "image/write_flat.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "core/text.h"
#include "image/encode.h"
#include "image/facts.h"
#include "image/icc_profile.h"
#include "image/output_metadata.h"
#include "image/parallel.h"

namespace afterglow {
namespace {

constexpr int kRows = 64;  // a strip

OIIO::TypeDesc oiio_type(SampleType type) {
  switch (type) {
    case SampleType::half: return OIIO::TypeHalf;
    case SampleType::float32: return OIIO::TypeFloat;
    case SampleType::uint16: return OIIO::TypeUInt16;
    default: return OIIO::TypeUInt8;
  }
}

bool is_integer(SampleType type) { return type == SampleType::uint8 || type == SampleType::uint16; }

void describe_color(OIIO::ImageSpec& spec, const OutputFormat& format, SampleType type, const FileFacts* facts) {
  if (!is_integer(type)) {
    spec.attribute("oiio:ColorSpace", "Linear");
    return;
  }
  spec.attribute("oiio:ColorSpace", "sRGB");
  // PNG has a chunk that says sRGB; the others say nothing or carry a profile, as the input did.
  if (!facts || !facts->had_profile || format.kind == OutputKind::png) return;
  const std::vector<std::uint8_t> profile = srgb_icc_profile();
  if (!profile.empty()) spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(profile.size())), profile.data());
}

OIIO::ImageSpec spec_for(const Picture& picture, const OutputFormat& format, SampleType type, bool alpha, const WriteOptions& options) {
  OIIO::ImageSpec spec(picture.display_window.width, picture.display_window.height, alpha ? 4 : 3, oiio_type(type));
  if (picture.facts) spec.extra_attribs = kept_metadata(*picture.facts);
  describe_color(spec, format, type, picture.facts.get());
  if (alpha) {
    spec.alpha_channel = 3;
    if (is_integer(type)) spec.attribute("oiio:UnassociatedAlpha", 1);
  }
  switch (format.kind) {
    case OutputKind::png: spec.attribute("png:compressionLevel", std::clamp(options.png_level, 0, 9)); break;
    case OutputKind::jpeg:
      spec.attribute("CompressionQuality", std::clamp(options.jpeg_quality, 1, 100));
      spec.attribute("jpeg:subsampling", "4:4:4");
      break;
    case OutputKind::tiff: spec.attribute("compression", options.compression.empty() ? "zip" : lower(options.compression)); break;
    default: break;
  }
  return spec;
}

/// Whether dropping alpha changes what is seen.
bool has_transparency(const Picture& picture) {
  for (std::size_t i = 3; i < picture.color.pixels.size(); i += 4)
    if (picture.color.pixels[i] < 1) return true;
  return false;
}

/// Rows [first, first + rows) of the display window, encoded into `bytes`.
void encode_strip(const Picture& picture, SampleType type, bool alpha, bool dither, int first, int rows, std::vector<std::uint8_t>& bytes) {
  const int width = picture.display_window.width, channels = alpha ? 4 : 3;
  const float padding = picture.has_alpha ? 0.0f : 1.0f;
  const std::size_t row_samples = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  const std::size_t sample = oiio_type(type).size();
  bytes.resize(row_samples * sample * static_cast<std::size_t>(rows));
  const CodeRules rules{type == SampleType::uint16 ? 65535 : 255, alpha, dither};
  parallel_rows(rows, static_cast<long long>(row_samples) * rows, [&](int begin, int end) {
    std::vector<float> rgba(static_cast<std::size_t>(width) * 4), packed(row_samples);
    for (int i = begin; i < end; ++i) {
      std::uint8_t* out = bytes.data() + row_samples * sample * static_cast<std::size_t>(i);
      display_row(picture, first + i, padding, rgba.data());
      if (type == SampleType::uint8) {
        encode_row(rules, rgba.data(), width, 0, first + i, out);
      } else if (type == SampleType::uint16) {
        encode_row(rules, rgba.data(), width, 0, first + i, reinterpret_cast<std::uint16_t*>(out));
      } else {
        for (int x = 0; x < width; ++x) std::copy_n(&rgba[static_cast<std::size_t>(x) * 4], channels, &packed[static_cast<std::size_t>(x) * static_cast<std::size_t>(channels)]);
        if (type == SampleType::half) {
          to_half(packed.data(), reinterpret_cast<std::uint16_t*>(out), row_samples);
        } else {
          std::copy_n(packed.data(), row_samples, reinterpret_cast<float*>(out));
        }
      }
    }
  });
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
  for (int y = 0; y < spec.height; y += kRows)
    if (!input->read_scanlines(0, 0, y, std::min(y + kRows, spec.height), 0, 0, spec.nchannels, spec.format, rows.data()))
      return Error{ErrorKind::io, "cannot be written: reading it back failed: " + trim(input->geterror())};
  return {};
}

}  // namespace

Result<void> write_flat(const Picture& picture, const OutputFormat& format, OutputFile* out, const std::string& name,
                        const WriteOptions& options, Diagnostics& diagnostics) {
  const SampleType type = sample_type(format, options, picture.facts.get());
  const bool alpha = picture.has_alpha && format.alpha;
  if (picture.has_alpha && !alpha && has_transparency(picture))
    diagnostics.warn(fmt::format("{} files have no alpha; the picture is put on black", format.extensions[0].substr(1)));
  const OIIO::ImageSpec spec = spec_for(picture, format, type, alpha, options);
  const auto output = OIIO::ImageOutput::create(format.name);
  if (!output) return Error{ErrorKind::io, fmt::format("cannot be written: OpenImageIO has no {} writer", format.name)};
  std::optional<OiioOutput> proxy;
  if (out) output->set_ioproxy(&proxy.emplace(*out, name));
  if (!output->open(name, spec)) return library_failed(*output);
  std::vector<std::uint8_t> strip;
  for (int y = 0; y < spec.height; y += kRows) {
    const int rows = std::min(kRows, spec.height - y);
    encode_strip(picture, type, alpha, options.dither, y, rows, strip);
    if (!output->write_scanlines(y, y + rows, 0, oiio_type(type), strip.data()) || (out && out->failure())) return library_failed(*output);
  }
  if (!output->close()) return library_failed(*output);
  return out ? Result<void>() : read_back(name);
}

}  // namespace afterglow
