// SPDX-License-Identifier: MIT
// Metadata that formats write in ways of their own: time codes, rates and numbers as text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "image/metadata.h"

namespace afterglow {

/// The time code of a picture is text here: "01:02:03:04", with ";" before the frames where numbers are dropped. Bits
/// of fields and of users are not part of it.
inline constexpr const char* kTimeCodeName = "smpte:TimeCode";
/// Of 32 bits as SMPTE 12M and EXR (TV60) have them; empty: no time of day.
std::string time_code_text(std::uint32_t coded);
/// The other way; nothing when the text is none.
std::optional<std::uint32_t> time_code_of(std::string_view text);

/// Frames a second: 24, 24000/1001 for 23.976. Nothing when it is no rate.
std::optional<Rational> rate_of(const MetadataValue& value);

/// Whether formats whose metadata is text alone (PNG) keep this number as one.
bool is_kept_as_text(std::string_view name);
/// "2.8", "1/50" as such numbers are read back; nothing when the text is none.
std::optional<MetadataValue> number_of_text(std::string_view text);
/// So that `number_of_text` makes the same of it.
std::string text_of_number(const MetadataValue& value);

}  // namespace afterglow
