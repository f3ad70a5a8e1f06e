// SPDX-License-Identifier: MIT
#include "image/exr_metadata.h"

#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <OpenEXR/ImfTimeCodeAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "core/text.h"
#include "image/kept_values.h"
#include "image/time_code.h"

namespace afterglow {
namespace {

enum class Kind { text, number, whole, rate };
struct NamePair {
  const char* exr;
  const char* general;
  Kind kind;  ///< EXR's standard attributes have fixed types; `whole` is a float there and an integer in Exif
};
/// The same pairs as in OpenImageIO's reader and writer.
constexpr std::array kNames{
    NamePair{"owner", "Copyright", Kind::text},
    NamePair{"comments", "ImageDescription", Kind::text},
    NamePair{"capDate", "DateTime", Kind::text},
    NamePair{"altitude", "GPS:Altitude", Kind::number},
    NamePair{"expTime", "ExposureTime", Kind::number},
    NamePair{"aperture", "FNumber", Kind::number},
    NamePair{"isoSpeed", "Exif:PhotographicSensitivity", Kind::whole},  // its name in Exif since 2.3
    NamePair{"isoSpeed", "Exif:ISOSpeedRatings", Kind::whole},
    NamePair{"focus", "Exif:SubjectDistance", Kind::number},
    NamePair{"framesPerSecond", "FramesPerSecond", Kind::rate},
    NamePair{"pixelAspectRatio", "PixelAspectRatio", Kind::number},
};

/// Names whose types OpenEXR prescribes: a text of a PNG that is called "timeCode" must not become one of them.
constexpr std::array<std::string_view, 40> kReserved{"chromaticities",
                                                     "whiteLuminance",
                                                     "adoptedNeutral",
                                                     "renderingTransform",
                                                     "lookModTransform",
                                                     "xDensity",
                                                     "owner",
                                                     "comments",
                                                     "capDate",
                                                     "utcOffset",
                                                     "longitude",
                                                     "latitude",
                                                     "altitude",
                                                     "focus",
                                                     "expTime",
                                                     "aperture",
                                                     "isoSpeed",
                                                     "envmap",
                                                     "keyCode",
                                                     "timeCode",
                                                     "wrapmodes",
                                                     "framesPerSecond",
                                                     "multiView",
                                                     "worldToCamera",
                                                     "worldToNDC",
                                                     "deepImageState",
                                                     "originalDataWindow",
                                                     "dwaCompressionLevel",
                                                     "preview",
                                                     "screenWindowCenter",
                                                     "screenWindowWidth",
                                                     "name",
                                                     "type",
                                                     "version",
                                                     "chunkCount",
                                                     "view",
                                                     "channels",
                                                     "compression",
                                                     "lineOrder",
                                                     "tiles"};

const NamePair* pair_of_exr(std::string_view name) {
  for (const NamePair& pair : kNames)
    if (name == pair.exr) return &pair;
  return nullptr;
}

const NamePair* pair_of(const std::string& name) {
  for (const NamePair& pair : kNames)
    if (name == pair.general) return &pair;
  return nullptr;
}

template <class A>
const A* as(const Imf::Attribute& attribute) {
  return dynamic_cast<const A*>(&attribute);
}

std::vector<float> floats_of(const float* values, std::size_t count) { return {values, values + count}; }

void insert(Imf::Header& header, const std::string& name, const MetadataValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) {
    header.insert(name, Imf::StringAttribute(*text));
  } else if (const auto* integer = std::get_if<int>(&value)) {
    header.insert(name, Imf::IntAttribute(*integer));
  } else if (const auto* number = std::get_if<float>(&value)) {
    header.insert(name, Imf::FloatAttribute(*number));
  } else if (const auto* rational = std::get_if<Rational>(&value)) {
    if (rational->denominator > 0)
      header.insert(name, Imf::RationalAttribute(
                              Imf::Rational(rational->numerator, static_cast<unsigned>(rational->denominator))));
  } else if (const auto* floats = std::get_if<std::vector<float>>(&value)) {
    const std::vector<float>& f = *floats;
    if (f.size() == 2) header.insert(name, Imf::V2fAttribute(Imath::V2f(f[0], f[1])));
    if (f.size() == 3) header.insert(name, Imf::V3fAttribute(Imath::V3f(f[0], f[1], f[2])));
    if (f.size() == 16) {
      Imath::M44f matrix;
      std::copy_n(f.begin(), 16, matrix.getValue());
      header.insert(name, Imf::M44fAttribute(matrix));
    }
  }
}

/// Pixels per inch; 0: they do not say, or of what.
float density_of(const Metadata& metadata) {
  const MetadataValue *x = find_metadata(metadata, "XResolution"), *unit = find_metadata(metadata, "ResolutionUnit");
  const std::string name = unit ? lower(metadata_text(*unit)) : "";
  const float inches = name.starts_with("in") ? 1 : name.starts_with("cm") ? 2.54f : name == "m" ? 0.0254f : 0;
  const float density = x ? metadata_number(*x, 0) * inches : 0;
  return std::isfinite(density) && density > 0 ? density : 0;
}

/// `ratio`: width of a pixel to its height.
void add_density(Metadata& list, float density, float ratio) {
  if (!(density > 0) || !std::isfinite(density)) return;
  list.push_back({"XResolution", density});
  list.push_back({"YResolution", ratio > 0 && std::isfinite(ratio) ? density * ratio : density});
  list.push_back({"ResolutionUnit", std::string("in")});
}

void insert_pair(Imf::Header& header, const NamePair& pair, const MetadataValue& value) {
  switch (pair.kind) {
    case Kind::text:
      header.insert(pair.exr, Imf::StringAttribute(metadata_text(value)));
      break;
    case Kind::number:
    case Kind::whole:
      if (const float number = metadata_number(value, 0); std::isfinite(number) && number > 0)
        header.insert(pair.exr, Imf::FloatAttribute(number));
      break;
    case Kind::rate:
      if (const auto rate = rate_of(value))
        header.insert(pair.exr,
                      Imf::RationalAttribute(Imf::Rational(rate->numerator, static_cast<unsigned>(rate->denominator))));
      break;
  }
}

}  // namespace

Metadata metadata_of(const Imf::Header& header) {
  Metadata list;
  for (auto it = header.begin(); it != header.end(); ++it) {
    const Imf::Attribute& attribute = it.attribute();
    if (std::string_view(it.name()) == "xDensity") continue;
    const NamePair* pair = pair_of_exr(it.name());
    MetadataEntry entry{pair ? pair->general : it.name(), {}};
    if (const auto* text = as<Imf::StringAttribute>(attribute)) {
      entry.value = text->value();
    } else if (const auto* integer = as<Imf::IntAttribute>(attribute)) {
      entry.value = integer->value();
    } else if (const auto* number = as<Imf::FloatAttribute>(attribute)) {
      entry.value = number->value();
      if (pair && pair->kind == Kind::whole && number->value() >= 1 && number->value() < 1e9f)
        entry.value = static_cast<int>(std::lround(number->value()));
    } else if (const auto* wide = as<Imf::DoubleAttribute>(attribute)) {
      entry.value = static_cast<float>(wide->value());
    } else if (const auto* rational = as<Imf::RationalAttribute>(attribute)) {
      entry.value = Rational{rational->value().n, static_cast<int>(rational->value().d)};
    } else if (const auto* v2f = as<Imf::V2fAttribute>(attribute)) {
      entry.value = floats_of(&v2f->value().x, 2);
    } else if (const auto* v3f = as<Imf::V3fAttribute>(attribute)) {
      entry.value = floats_of(&v3f->value().x, 3);
    } else if (const auto* m44f = as<Imf::M44fAttribute>(attribute)) {
      entry.value = floats_of(m44f->value().getValue(), 16);
    } else if (const auto* time = as<Imf::TimeCodeAttribute>(attribute)) {
      std::string code = time_code_text(time->value().timeAndFlags());
      if (code.empty() || std::string_view(it.name()) != "timeCode") continue;
      entry = {kTimeCodeName, std::move(code)};
    } else {
      continue;
    }
    list.push_back(std::move(entry));
  }
  if (const auto* density = header.findTypedAttribute<Imf::FloatAttribute>("xDensity"))
    add_density(list, density->value(), header.pixelAspectRatio());
  return list;
}

void add_metadata(Imf::Header& header, const Metadata& metadata) {
  const float density = density_of(metadata);
  if (density > 0) header.insert("xDensity", Imf::FloatAttribute(density));
  for (const auto& [name, value] : metadata) {
    if (const NamePair* pair = pair_of(name)) {
      insert_pair(header, *pair, value);
      continue;
    }
    if (name == kTimeCodeName) {
      if (const auto* text = std::get_if<std::string>(&value))
        if (const auto coded = time_code_of(*text))
          header.insert("timeCode", Imf::TimeCodeAttribute(Imf::TimeCode(*coded)));
      continue;
    }
    if (density > 0 && (name == "XResolution" || name == "YResolution" || name == "ResolutionUnit")) continue;
    const bool reserved = std::find(kReserved.begin(), kReserved.end(), name) != kReserved.end();
    if (name.empty() || name.size() > 255 || reserved || header.find(name) != header.end()) continue;
    insert(header, name, value);
  }
}

}  // namespace afterglow
