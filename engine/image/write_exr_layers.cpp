// SPDX-License-Identifier: MIT
#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepScanLineInputPart.h>
#include <OpenEXR/ImfDeepScanLineOutputPart.h>
#include <OpenEXR/ImfDeepTiledInputPart.h>
#include <OpenEXR/ImfDeepTiledOutputPart.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTiledInputPart.h>
#include <OpenEXR/ImfTiledOutputPart.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/text.h"
#include "image/exr_kept_channels.h"
#include "image/exr_line_writer.h"
#include "image/exr_primaries.h"
#include "image/exr_rows.h"
#include "image/metadata.h"
#include "image/write_exr.h"

namespace afterglow {
namespace {

constexpr const char* kLossless = "zip";

/// What the colour's layer looks like in the new file.
struct Replacement {
  std::array<std::string, 4> names;   ///< of R, G, B, A; A may be empty
  std::vector<std::string> replaced;  ///< names in the old file that they stand for
};

/// Errors: io (one channel of a layer was chosen that has colours of its own, which the result would take the place
/// of).
Result<Replacement> replacement_for(const FileFacts& facts, const Picture& picture) {
  Replacement result;
  result.names = facts.color_channels;
  for (const std::string& name : facts.color_channels)
    if (!name.empty()) result.replaced.push_back(name);
  const std::string first = facts.color_channels[0];
  const std::string prefix = first.substr(0, first.rfind('.') + 1);  // npos + 1 is 0
  if (facts.color_channels[0] == facts.color_channels[1]) {
    // Grey, or luminance and chroma: the result has colour.
    for (const char* chroma : {"RY", "BY"}) result.replaced.push_back(prefix + chroma);
    result.names = {prefix + "R", prefix + "G", prefix + "B", facts.color_channels[3]};
    for (const std::string& name : {result.names[0], result.names[1], result.names[2]})
      if (name != first && facts.exr_header->channels().findChannel(name))
        return Error{ErrorKind::io,
                     fmt::format("cannot keep layers: what is made of '{}' would take the place of '{}'", first, name)};
    for (const std::string& name : result.names)
      if (!name.empty()) result.replaced.push_back(name);
  }
  for (std::size_t c = 0; c < 3; ++c)  // a layer that lacks a colour gets it
    if (result.names[c].empty()) result.names[c] = prefix + "RGB"[c];
  if (!picture.has_alpha) result.names[3].clear();
  return result;
}

Result<void> check_unchanged(const Imf::MultiPartInputFile& input, const FileFacts& facts) {
  const Error changed{ErrorKind::io,
                      fmt::format("cannot keep layers: '{}' has changed since it was read", facts.file.string())};
  if (facts.part >= input.parts()) return changed;
  const Imf::Header& now = input.header(facts.part);
  if (now.dataWindow() != facts.exr_header->dataWindow() || !(now.channels() == facts.exr_header->channels()))
    return changed;
  return {};
}

Imf::Header color_header(const Imf::Header& old, const FileFacts& facts, const Imath::Box2i& window,
                         const ExrColorRows& color, const ExrKeptChannels& others) {
  // Built anew rather than by erasing from a copy: Header::erase of OpenEXR 3.1 leaks.
  constexpr std::array<std::string_view, 7> kGone{"tiles",         "preview",  "chunkCount", "dwaCompressionLevel",
                                                  "textureformat", "channels", "dataWindow"};
  Imf::Header header(old.displayWindow(), window);
  for (auto it = old.begin(); it != old.end(); ++it)
    if (std::find(kGone.begin(), kGone.end(), it.name()) == kGone.end()) header.insert(it.name(), it.attribute());
  header.channels() = Imf::ChannelList();
  color.add_channels(header);
  others.add_channels(header);
  header.setType(Imf::SCANLINEIMAGE);
  header.lineOrder() = Imf::INCREASING_Y;
  if (facts.had_chromaticities) Imf::addChromaticities(header, exr_chromaticities(facts.primaries.value_or(kRec709)));
  return header;
}

/// Calls `write(first, rows)` for strips of rows, counted from the top of the window, once `others` holds theirs.
template <class Write>
void over_strips(Imf::MultiPartInputFile& input, int part, const Imath::Box2i& window, ExrKeptChannels& others,
                 const Write& write) {
  Imf::InputPart source(input, part);
  const int height = window.max.y - window.min.y + 1;
  for (int row = 0; row < height; row += ExrColorRows::kRows) {
    const int rows = std::min(ExrColorRows::kRows, height - row);
    others.read(source, window.min.y + row, rows);
    write(row, rows);
  }
}

void write_color_part(Imf::MultiPartInputFile& input, Imf::MultiPartOutputFile& output, int part, ExrColorRows& color,
                      ExrKeptChannels& others) {
  Imf::OutputPart target(output, part);
  over_strips(input, part, target.header().dataWindow(), others, [&](int row, int rows) {
    Imf::FrameBuffer buffer;
    others.add_slices(buffer);
    color.add_slices(row, rows, buffer);
    target.setFrameBuffer(buffer);
    target.writePixels(rows);
  });
}

/// The only part of a file, where it has zipped lines.
void write_only_part(Imf::MultiPartInputFile& input, OutputFile& out, const Imf::Header& header, ExrColorRows& color,
                     ExrKeptChannels& others) {
  color.find_places(header);
  ExrLineWriter file(header, out);
  over_strips(input, 0, header.dataWindow(), others, [&](int first, int rows) {
    file.write(rows, [&](int y, std::uint8_t* line) {
      color.put_row(y, line);
      others.put_row(header, y - first, line);
    });
  });
  file.finish();
}

/// Compression of the colour's part: what was asked for, unless other channels that lie in it would lose by it.
Result<std::string> compression_beside(const ExrKeptChannels& others, const std::string& wanted,
                                       Diagnostics& diagnostics) {
  AFTERGLOW_TRY(const Compression compression, parse_compression(wanted.empty() ? kLossless : wanted));
  const std::vector<std::string> changed = others.changed_by(compression.name);
  if (changed.empty()) return wanted;
  diagnostics.warn(fmt::format("--compression {} would change layers that are kept ({}); {} is taken", compression.name,
                               join(changed), kLossless));
  return std::string(kLossless);
}

/// Copies a part's compressed chunks as they are.
void copy_part(Imf::MultiPartInputFile& input, Imf::MultiPartOutputFile& output, int part) {
  const std::string type = output.header(part).type();
  if (type == Imf::TILEDIMAGE) {
    Imf::TiledInputPart source(input, part);
    Imf::TiledOutputPart(output, part).copyPixels(source);
  } else if (type == Imf::DEEPSCANLINE) {
    Imf::DeepScanLineInputPart source(input, part);
    Imf::DeepScanLineOutputPart(output, part).copyPixels(source);
  } else if (type == Imf::DEEPTILE) {
    Imf::DeepTiledInputPart source(input, part);
    Imf::DeepTiledOutputPart(output, part).copyPixels(source);
  } else {
    Imf::InputPart source(input, part);
    Imf::OutputPart(output, part).copyPixels(source);
  }
}

}  // namespace

Result<void> write_exr_with_layers(const Picture& picture, OutputFile& out, const std::string& name,
                                   const WriteOptions& options, Diagnostics& diagnostics) {
  const FileFacts* facts = picture.facts.get();
  if (!facts || !facts->exr_header) {
    diagnostics.warn("the input is no EXR file and has no layers to keep");
    return write_exr(picture, out, name, options, diagnostics);
  }
  if (facts->orientation > 1)
    return Error{ErrorKind::io, fmt::format("cannot keep layers of a picture that is stored turned (orientation {})",
                                            facts->orientation)};
  Imf::MultiPartInputFile input(facts->file.c_str());
  AFTERGLOW_CHECK(check_unchanged(input, *facts));
  AFTERGLOW_TRY(const OutputFormat* format, output_format("x.exr", options));
  AFTERGLOW_TRY(const Replacement replacement, replacement_for(*facts, picture));
  ExrColorRows color(picture, replacement.names, sample_type(*format, options, facts));
  const Imath::Box2i window = exr_window(picture.data_window);
  ExrKeptChannels others(input.header(facts->part), replacement.replaced, window);
  AFTERGLOW_CHECK(others.check());

  std::vector<Imf::Header> headers;
  for (int part = 0; part < input.parts(); ++part) headers.push_back(input.header(part));
  headers[static_cast<std::size_t>(facts->part)] =
      color_header(input.header(facts->part), *facts, window, color, others);
  AFTERGLOW_TRY(const std::string compression, compression_beside(others, options.compression, diagnostics));
  AFTERGLOW_CHECK(set_compression(headers[static_cast<std::size_t>(facts->part)], compression));
  if (headers.size() == 1 && can_pack_lines(headers[0])) {
    write_only_part(input, out, headers[0], color, others);
  } else {
    ExrOutput stream(out, name.c_str());
    Imf::MultiPartOutputFile output(stream, headers.data(), static_cast<int>(headers.size()));
    for (int part = 0; part < input.parts(); ++part) {
      if (part == facts->part) {
        write_color_part(input, output, part, color, others);
      } else {
        copy_part(input, output, part);
      }
    }
  }
  color.warn_of_overflow(headers[static_cast<std::size_t>(facts->part)], diagnostics);
  return {};
}

}  // namespace afterglow
