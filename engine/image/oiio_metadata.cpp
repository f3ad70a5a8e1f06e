// SPDX-License-Identifier: MIT
#include "image/oiio_metadata.h"

#include "image/kept_values.h"
#include "image/time_code.h"

// The header of OpenImageIO that declares it (tiffutils) wants those of libtiff.
OIIO_NAMESPACE_BEGIN
OIIO_API bool decode_exif(string_view exif, ImageSpec& spec);
OIIO_API void encode_exif(const ImageSpec& spec, std::vector<char>& blob);
OIIO_NAMESPACE_END

namespace afterglow {
namespace {

/// GPS:Latitude, GPS:Longitude and such: degrees, minutes, seconds.
constexpr int kPlaceParts = 3;
bool is_place(std::string_view name) { return name.starts_with("GPS:"); }

constexpr const char* kDpxRate = "dpx:FrameRate";

/// True: it has a form of its own in some format.
bool add_special(OIIO::ParamValueList& list, const std::string& name, const MetadataValue& value) {
  if (name == kTimeCodeName) {
    const auto* text = std::get_if<std::string>(&value);
    const auto coded = text ? time_code_of(*text) : std::nullopt;
    if (!coded) return false;
    const std::uint32_t parts[2] = {*coded, 0};  // no bits of users
    list.attribute(name, OIIO::TypeTimeCode, parts);
    return true;
  }
  if (name == "ResolutionUnit") {
    const std::string unit = metadata_text(value);
    list.attribute(name,
                   unit.starts_with("in") ? "in" : unit);  // PNG's reader says "inch", which JPEG's writer ignores
    return true;
  }
  if (name == "FramesPerSecond")
    if (const auto rate = rate_of(value))
      list.attribute(kDpxRate, static_cast<float>(rate->numerator) / static_cast<float>(rate->denominator));
  return false;
}

}  // namespace

Metadata metadata_of(const OIIO::ParamValueList& list) {
  Metadata metadata;
  for (const OIIO::ParamValue& param : list) {
    const OIIO::TypeDesc type = param.type();
    const auto* floats = static_cast<const float*>(param.data());
    MetadataEntry entry{param.name().string(), {}};
    if (type == OIIO::TypeString) {
      entry.value = param.get_string();
      const auto& text = std::get<std::string>(entry.value);
      if (entry.name == "DateTime" && text.find_first_not_of(" :") == std::string::npos) continue;  // "unknown"
      if (is_kept_as_text(entry.name))
        if (auto number = number_of_text(entry.name, text)) entry.value = *std::move(number);
    } else if (type == OIIO::TypeTimeCode) {
      std::string code = time_code_text(*static_cast<const std::uint32_t*>(param.data()));
      if (code.empty()) continue;
      entry.value = std::move(code);
    } else if (type == OIIO::TypeRational) {
      const auto* parts = static_cast<const int*>(param.data());
      entry.value = Rational{parts[0], parts[1]};
    } else if (type == OIIO::TypeFloat) {
      entry.value = *floats;
    } else if (type.basetype == OIIO::TypeDesc::FLOAT && param.nvalues() == 1 && type.arraylen == 0 &&
               (type.aggregate == OIIO::TypeDesc::VEC2 || type.aggregate == OIIO::TypeDesc::VEC3 ||
                type.aggregate == OIIO::TypeDesc::MATRIX44)) {
      entry.value = std::vector<float>(floats, floats + static_cast<int>(type.aggregate));
    } else if (is_place(entry.name) && type.basetype == OIIO::TypeDesc::FLOAT && type.arraylen == kPlaceParts) {
      entry.value = std::vector<float>(floats, floats + kPlaceParts);
    } else if (type.is_array() || type.aggregate != OIIO::TypeDesc::SCALAR || type.is_floating_point() ||
               type.basetype == OIIO::TypeDesc::PTR) {
      continue;  // maker notes and other tables of bytes
    } else {
      entry.value = param.get_int();
    }
    if (entry.name == kDpxRate && !find_metadata(metadata, "FramesPerSecond"))
      if (const auto rate = rate_of(entry.value)) metadata.push_back({"FramesPerSecond", *rate});
    metadata.push_back(std::move(entry));
  }
  return metadata;
}

void correct_jpeg_shape(Metadata& metadata) {
  constexpr const char* kShape = "PixelAspectRatio";
  const auto number = [&](const char* name) {
    const MetadataValue* value = find_metadata(metadata, name);
    return value ? metadata_number(*value, 0) : 0.0f;
  };
  const MetadataValue* unit = find_metadata(metadata, "ResolutionUnit");
  const std::string text = unit ? metadata_text(*unit) : "";
  const float x = number("XResolution"), y = number("YResolution");
  if (!(text.starts_with("in") || text.starts_with("cm")) || !(x > 0 && y > 0)) return;
  std::erase_if(metadata, [&](const MetadataEntry& entry) { return entry.name == kShape; });
  if (x != y) metadata.push_back({kShape, y / x});
}

void add_exif(std::span<const std::uint8_t> exif, OIIO::ImageSpec& spec) {
  if (!exif.empty()) OIIO::decode_exif({reinterpret_cast<const char*>(exif.data()), exif.size()}, spec);
}

std::vector<char> exif_of(const OIIO::ParamValueList& list) {
  if (list.empty()) return {};
  OIIO::ImageSpec spec;
  spec.extra_attribs = list;
  std::vector<char> block;
  OIIO::encode_exif(spec, block);
  return block;
}

OIIO::ParamValueList param_list(const Metadata& metadata) {
  OIIO::ParamValueList list;
  for (const auto& [name, value] : metadata) {
    if (add_special(list, name, value)) continue;
    if (const auto* text = std::get_if<std::string>(&value)) {
      list.attribute(name, *text);
    } else if (const auto* integer = std::get_if<int>(&value)) {
      list.attribute(name, *integer);
    } else if (const auto* number = std::get_if<float>(&value)) {
      list.attribute(name, *number);
    } else if (const auto* rational = std::get_if<Rational>(&value)) {
      const int parts[2] = {rational->numerator, rational->denominator};
      list.attribute(name, OIIO::TypeRational, parts);
    } else if (const auto* floats = std::get_if<std::vector<float>>(&value)) {
      const auto count = static_cast<int>(floats->size());
      const OIIO::TypeDesc type =
          is_place(name) ? OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::SCALAR, count)
                         : OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, static_cast<OIIO::TypeDesc::AGGREGATE>(count));
      list.attribute(name, type, floats->data());
    }
  }
  return list;
}

}  // namespace afterglow
