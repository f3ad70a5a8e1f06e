// SPDX-License-Identifier: MIT
// Metadata that formats write in ways of their own: rates and numbers as text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "image/metadata.h"

namespace afterglow {

/// Frames a second: 24, 24000/1001 for 23.976. Nothing when it is no rate.
std::optional<Rational> rate_of(const MetadataValue& value);

/// Whether formats whose metadata is text alone (PNG) keep this number as one.
bool is_kept_as_text(std::string_view name);
/// "2.8", "1/50" as such numbers are read back, those that are fractions in Exif (apertures) as such; nothing when the
/// text is none.
std::optional<MetadataValue> number_of_text(std::string_view name, std::string_view text);
/// So that `number_of_text` makes the same of it.
std::string text_of_number(const MetadataValue& value);

}  // namespace afterglow
