#include "image/exr_metadata.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>

namespace afterglow {
namespace {

enum class Kind { text, number };
struct NamePair {
  const char* exr;
  const char* general;
  Kind kind;  ///< EXR's standard attributes have fixed types
};
/// The same pairs as in OpenImageIO's reader and writer.
constexpr std::array kNames{
    NamePair{"owner", "Copyright", Kind::text},
    NamePair{"comments", "ImageDescription", Kind::text},
    NamePair{"capDate", "DateTime", Kind::text},
    NamePair{"altitude", "GPS:Altitude", Kind::number},
    NamePair{"expTime", "ExposureTime", Kind::number},
    NamePair{"aperture", "FNumber", Kind::number},
    NamePair{"isoSpeed", "Exif:ISOSpeedRatings", Kind::number},
    NamePair{"focus", "Exif:SubjectDistance", Kind::number},
    NamePair{"pixelAspectRatio", "PixelAspectRatio", Kind::number},
};

/// Names whose types OpenEXR prescribes: a text of a PNG that is called "timeCode" must not become one of them.
constexpr std::array<std::string_view, 40> kReserved{
    "chromaticities", "whiteLuminance", "adoptedNeutral", "renderingTransform", "lookModTransform", "xDensity", "owner", "comments", "capDate",
    "utcOffset", "longitude", "latitude", "altitude", "focus", "expTime", "aperture", "isoSpeed", "envmap", "keyCode", "timeCode", "wrapmodes",
    "framesPerSecond", "multiView", "worldToCamera", "worldToNDC", "deepImageState", "originalDataWindow", "dwaCompressionLevel", "preview",
    "screenWindowCenter", "screenWindowWidth", "name", "type", "version", "chunkCount", "view", "channels", "compression", "lineOrder", "tiles"};

std::string general_name(const std::string& name) {
  for (const NamePair& pair : kNames)
    if (name == pair.exr) return pair.general;
  return name;
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

}  // namespace

OIIO::ParamValueList metadata_of(const Imf::Header& header) {
  OIIO::ParamValueList list;
  for (auto it = header.begin(); it != header.end(); ++it) {
    const std::string name = general_name(it.name());
    const Imf::Attribute& attribute = it.attribute();
    if (const auto* text = as<Imf::StringAttribute>(attribute)) {
      list.attribute(name, text->value());
    } else if (const auto* integer = as<Imf::IntAttribute>(attribute)) {
      list.attribute(name, integer->value());
    } else if (const auto* number = as<Imf::FloatAttribute>(attribute)) {
      list.attribute(name, number->value());
    } else if (const auto* wide = as<Imf::DoubleAttribute>(attribute)) {
      list.attribute(name, static_cast<float>(wide->value()));
    } else if (const auto* v2f = as<Imf::V2fAttribute>(attribute)) {
      list.attribute(name, OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::VEC2), &v2f->value());
    } else if (const auto* v3f = as<Imf::V3fAttribute>(attribute)) {
      list.attribute(name, OIIO::TypeVector, &v3f->value());
    } else if (const auto* m44f = as<Imf::M44fAttribute>(attribute)) {
      list.attribute(name, OIIO::TypeMatrix, &m44f->value());
    } else if (const auto* rational = as<Imf::RationalAttribute>(attribute)) {
      const std::array<int, 2> parts{rational->value().n, static_cast<int>(rational->value().d)};
      list.attribute(name, OIIO::TypeRational, parts.data());
    }
  }
  return list;
}

void add_metadata(Imf::Header& header, const OIIO::ParamValueList& metadata) {
  for (const OIIO::ParamValue& value : metadata) {
    const std::string name = value.name().string();
    const OIIO::TypeDesc type = value.type();
    if (const NamePair* pair = pair_of(name)) {
      if (pair->kind == Kind::text) {
        header.insert(pair->exr, Imf::StringAttribute(value.get_string()));
      } else if (const float number = value.get_float(); std::isfinite(number) && number > 0) {
        header.insert(pair->exr, Imf::FloatAttribute(number));
      }
      continue;
    }
    const bool reserved = std::find(kReserved.begin(), kReserved.end(), name) != kReserved.end();
    if (name.empty() || name.size() > 255 || reserved || header.find(name) != header.end()) continue;
    const auto* floats = static_cast<const float*>(value.data());
    if (type == OIIO::TypeString) {
      header.insert(name, Imf::StringAttribute(value.get_string()));
    } else if (type == OIIO::TypeInt || type == OIIO::TypeUInt || type == OIIO::TypeDesc::UINT16) {
      header.insert(name, Imf::IntAttribute(value.get_int()));
    } else if (type == OIIO::TypeFloat) {
      header.insert(name, Imf::FloatAttribute(*floats));
    } else if (type == OIIO::TypeRational) {
      const auto* parts = static_cast<const int*>(value.data());
      if (parts[1] > 0) header.insert(name, Imf::RationalAttribute(Imf::Rational(parts[0], static_cast<unsigned>(parts[1]))));
    } else if (type == OIIO::TypeMatrix) {
      Imath::M44f matrix;
      std::copy_n(floats, 16, matrix.getValue());
      header.insert(name, Imf::M44fAttribute(matrix));
    } else if (type.basetype == OIIO::TypeDesc::FLOAT && type.aggregate == OIIO::TypeDesc::VEC3 && type.arraylen == 0) {
      header.insert(name, Imf::V3fAttribute(Imath::V3f(floats[0], floats[1], floats[2])));
    } else if (type.basetype == OIIO::TypeDesc::FLOAT && type.aggregate == OIIO::TypeDesc::VEC2 && type.arraylen == 0) {
      header.insert(name, Imf::V2fAttribute(Imath::V2f(floats[0], floats[1])));
    }
  }
}

}  // namespace afterglow
