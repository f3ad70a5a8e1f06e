// SPDX-License-Identifier: MIT
#include "image/oiio_metadata.h"

namespace afterglow {

Metadata metadata_of(const OIIO::ParamValueList& list) {
  Metadata metadata;
  for (const OIIO::ParamValue& param : list) {
    const OIIO::TypeDesc type = param.type();
    const auto* floats = static_cast<const float*>(param.data());
    MetadataEntry entry{param.name().string(), {}};
    if (type == OIIO::TypeString) {
      entry.value = param.get_string();
    } else if (type == OIIO::TypeRational) {
      const auto* parts = static_cast<const int*>(param.data());
      entry.value = Rational{parts[0], parts[1]};
    } else if (type == OIIO::TypeFloat) {
      entry.value = *floats;
    } else if (type.basetype == OIIO::TypeDesc::FLOAT && param.nvalues() == 1 && type.arraylen == 0 &&
               (type.aggregate == OIIO::TypeDesc::VEC2 || type.aggregate == OIIO::TypeDesc::VEC3 ||
                type.aggregate == OIIO::TypeDesc::MATRIX44)) {
      entry.value = std::vector<float>(floats, floats + static_cast<int>(type.aggregate));
    } else if (type.is_array() || type.aggregate != OIIO::TypeDesc::SCALAR || type.is_floating_point() ||
               type.basetype == OIIO::TypeDesc::PTR) {
      continue;  // maker notes and other tables of bytes
    } else {
      entry.value = param.get_int();
    }
    metadata.push_back(std::move(entry));
  }
  return metadata;
}

OIIO::ParamValueList param_list(const Metadata& metadata) {
  OIIO::ParamValueList list;
  for (const auto& [name, value] : metadata) {
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
      const auto aggregate = static_cast<OIIO::TypeDesc::AGGREGATE>(floats->size());
      list.attribute(name, OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, aggregate), floats->data());
    }
  }
  return list;
}

}  // namespace afterglow
