// SPDX-License-Identifier: MIT
#include "image/output_metadata.h"

#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "core/text.h"
#include "image/exr_metadata.h"
#include "image/orientation.h"

namespace afterglow {
namespace {

/// Lower case. Names alone, and whole families.
constexpr std::array<std::string_view, 35> kDropped{"compression",
                                                    "compressionquality",
                                                    "dwacompressionlevel",
                                                    "orientation",
                                                    "chromaticities",
                                                    "gamma",
                                                    "colorspace",
                                                    "exif:colorspace",
                                                    "exif:pixelxdimension",
                                                    "exif:pixelydimension",
                                                    "exif:gamma",
                                                    "colorinteropid",
                                                    "acesimagecontainerflag",
                                                    "blendermultichannel",
                                                    "multiview",
                                                    "channels",
                                                    "datawindow",
                                                    "displaywindow",
                                                    "lineorder",
                                                    "tiles",
                                                    "name",
                                                    "type",
                                                    "version",
                                                    "chunkcount",
                                                    "maxsamplesperpixel",
                                                    "deepimagestate",
                                                    "preview",
                                                    "textureformat",
                                                    "planarconfig",
                                                    "bitspersample",
                                                    "hash",
                                                    "sha-1",
                                                    "photometricinterpretation",
                                                    "rowsperstrip",
                                                    "iccprofile"};
constexpr std::array<std::string_view, 9> kDroppedFamilies{
    "oiio:", "openexr:", "png:", "jpeg:", "tiff:", "iccprofile:", "thumbnail", "gif:", "webp:"};

/// Of film scans (dpx:, cineon:), what is no word about the old file's samples.
constexpr std::array<std::string_view, 16> kFilmFacts{"framerate",
                                                      "temporalframerate",
                                                      "frameposition",
                                                      "sequencelength",
                                                      "heldcount",
                                                      "shutterangle",
                                                      "frameid",
                                                      "slateinfo",
                                                      "format",
                                                      "filmedgecode",
                                                      "sourcedatetime",
                                                      "sourceimagefilename",
                                                      "inputdevice",
                                                      "inputdevicemodelnumber",
                                                      "inputdeviceserialnumber",
                                                      "userbits"};

/// What libraries write once more by themselves, beside the first name.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kTwice{
    {{"Artist", "IPTC:Creator"}, {"Copyright", "IPTC:CopyrightNotice"}, {"ImageDescription", "IPTC:Caption"}}};

bool is_said_twice(const Metadata& metadata, const std::string& name) {
  return std::ranges::any_of(
      kTwice, [&](const auto& pair) { return pair.second == name && find_metadata(metadata, pair.first); });
}

/// Names that mean nothing in an EXR: they are its owner's there. A "version" of 1 is that of deep parts.
bool is_own(const std::string& name, const Imf::Attribute& attribute) {
  const auto* version = dynamic_cast<const Imf::IntAttribute*>(&attribute);
  const std::string plain = lower(name);
  return plain == "gamma" || plain == "hash" || (plain == "version" && !(version && version->value() == 1));
}

/// The white that the old primaries had.
bool is_of_old_primaries(const std::string& name, const Imf::Header& from) {
  return name == "adoptedNeutral" && Imf::hasChromaticities(from) &&
         !(Imf::chromaticities(from) == Imf::Chromaticities());
}

/// How wide pixels are for their height, upright and scaled, where a file says that they are `ratio` as it stores them.
/// Pictures of square pixels that are given another shape are meant to have it, on square pixels.
float written_ratio(const FileFacts& facts, float ratio) {
  if (!(ratio > 0) || ratio == 1) return ratio;
  return static_cast<float>((swaps_axes(facts.orientation) ? 1 / ratio : ratio) * facts.widened);
}

/// PNG's limit for a keyword, and a size above which a text is no description any more.
constexpr std::size_t kLongestName = 79, kLongestText = 64 << 10;

}  // namespace

bool keeps_metadata(std::string_view name) {
  const std::string plain = lower(name);
  for (const std::string_view family : {"dpx:", "cineon:"})
    if (plain.starts_with(family))
      return std::ranges::find(kFilmFacts, std::string_view(plain).substr(family.size())) != kFilmFacts.end();
  return std::find(kDropped.begin(), kDropped.end(), plain) == kDropped.end() &&
         !starts_with_any(plain, kDroppedFamilies);
}

Metadata kept_metadata(const FileFacts& facts) {
  Metadata kept;
  for (MetadataEntry entry : facts.metadata) {
    if (!keeps_metadata(entry.name) || is_said_twice(facts.metadata, entry.name) || entry.name.empty() ||
        entry.name.size() > kLongestName)
      continue;
    if (const auto* text = std::get_if<std::string>(&entry.value); text && text->size() > kLongestText) continue;
    if (entry.name == "PixelAspectRatio") entry.value = written_ratio(facts, metadata_number(entry.value, 1));
    if (swaps_axes(facts.orientation)) {
      if (entry.name == "XResolution")
        entry.name = "YResolution";
      else if (entry.name == "YResolution")
        entry.name = "XResolution";
    }
    kept.push_back(std::move(entry));
  }
  return kept;
}

void add_kept_attributes(Imf::Header& header, const FileFacts& facts) {
  if (facts.exr_header) {
    for (auto it = facts.exr_header->begin(); it != facts.exr_header->end(); ++it)
      if ((keeps_metadata(it.name()) || is_own(it.name(), it.attribute())) &&
          !is_of_old_primaries(it.name(), *facts.exr_header))
        header.insert(it.name(), it.attribute());
  } else {
    add_metadata(header, kept_metadata(facts));
  }
  if (facts.exr_header) header.pixelAspectRatio() = written_ratio(facts, header.pixelAspectRatio());
  // The pixels are Rec.709 now; a file that said what its primaries were goes on saying so.
  if (facts.had_chromaticities) Imf::addChromaticities(header, Imf::Chromaticities());
}

}  // namespace afterglow
