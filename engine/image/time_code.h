// SPDX-License-Identifier: MIT
// Time codes of SMPTE 12M: as text, as the bits that EXR and DPX keep, and counted on.
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
/// Whether the text is one, whatever the frame's number.
bool is_time_code(std::string_view text);
/// The other way; nothing when the text is none, or has a frame's number above 39.
std::optional<std::uint32_t> time_code_of(std::string_view text);

/// The code of the frame that comes `frames` after that of `text`, which is one, at this rate; numbers are dropped
/// where `text` has ";" and the rate is near 30 or 60. A day later it begins anew. Empty: `text` is none, or not at
/// this rate.
std::string time_code_after(std::string_view text, long long frames, Rational rate);

}  // namespace afterglow
