// SPDX-License-Identifier: MIT
// Names that are spelled alike: ü as one character (NFC, as most systems write it) or as u and a mark (NFD, as files
// come from macOS).
#pragma once

#include <string>
#include <string_view>

namespace afterglow {

/// The characters of a text in UTF-8, letters with marks taken apart (NFD, but that several marks of one letter keep
/// their order). A byte that is no UTF-8 is a character of its own, above U+10FFFF.
std::u32string decomposed(std::string_view text);

/// The same in UTF-8, and the other way round: letters and marks put together where Unicode has one character for them.
std::string taken_apart(std::string_view text);
std::string put_together(std::string_view text);

/// Whether two texts are the same but for how letters with marks are written.
bool same_letters(std::string_view a, std::string_view b);

}  // namespace afterglow
