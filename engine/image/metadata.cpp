// SPDX-License-Identifier: MIT
#include "image/metadata.h"

#include <algorithm>

#include "core/text.h"

namespace afterglow {

const MetadataValue* find_metadata(const Metadata& metadata, std::string_view name) {
  const auto entry =
      std::find_if(metadata.begin(), metadata.end(), [&](const MetadataEntry& e) { return e.name == name; });
  return entry == metadata.end() ? nullptr : &entry->value;
}

float metadata_number(const MetadataValue& value, float otherwise) {
  if (const auto* integer = std::get_if<int>(&value)) return static_cast<float>(*integer);
  if (const auto* number = std::get_if<float>(&value)) return *number;
  if (const auto* rational = std::get_if<Rational>(&value); rational && rational->denominator != 0)
    return static_cast<float>(static_cast<double>(rational->numerator) / rational->denominator);
  return otherwise;
}

std::string metadata_text(const MetadataValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* floats = std::get_if<std::vector<float>>(&value)) {
    std::vector<std::string> numbers;
    for (const float f : *floats) numbers.push_back(number_text(f));
    return join(numbers);
  }
  return number_text(metadata_number(value, 0));
}

}  // namespace afterglow
