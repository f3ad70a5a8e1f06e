// SPDX-License-Identifier: MIT
#include "core/decomposed.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/letter_parts.inc"

namespace afterglow {
namespace {

constexpr char32_t kLast = 0x10ffff;
// Hangul: syllables are a lead, a vowel and perhaps a tail.
constexpr char32_t kSyllables = 0xac00, kSyllablesEnd = 0xd7a4, kLead = 0x1100, kVowel = 0x1161, kTail = 0x11a7;
constexpr char32_t kTails = 28, kOfLead = 21 * kTails;

/// Takes a character from the front of a text. Bytes that are no UTF-8 come one by one, above all characters.
char32_t take_character(std::string_view& text) {
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xc0 ? 0
                             : first < 0xe0 ? 2
                             : first < 0xf0 ? 3
                             : first < 0xf8 ? 4
                                            : 0;
  bool whole = length > 0 && length <= text.size();
  char32_t character = length < 2 ? first : first & (0x7f >> length);
  for (std::size_t i = 1; whole && i < length; ++i) {
    whole = (byte(i) & 0xc0) == 0x80;
    character = character << 6 | (byte(i) & 0x3f);
  }
  text.remove_prefix(whole ? length : 1);
  return whole ? character : kLast + 1 + first;
}

void put_parts(std::u32string& out, char32_t character) {
  if (character >= kSyllables && character < kSyllablesEnd) {
    const char32_t place = character - kSyllables, tail = place % kTails;
    out += kLead + place / kOfLead;
    out += kVowel + place % kOfLead / kTails;
    if (tail > 0) out += kTail + tail;
    return;
  }
  const auto* const part = std::ranges::lower_bound(kLetterParts, character, {}, &LetterParts::letter);
  if (character < 0x80 || part == std::end(kLetterParts) || part->letter != character) {
    out += character;
    return;
  }
  put_parts(out, part->base);  // which may have parts itself
  if (part->mark != 0) out += part->mark;
}

std::string utf8(const std::u32string& characters) {
  std::string out;
  for (const char32_t c : characters) {
    const auto tail = [&](unsigned shift) { out += static_cast<char>(0x80 | (c >> shift & 0x3f)); };
    if (c < 0x80 || c > kLast) {
      out += static_cast<char>(c & 0xff);
      continue;
    }
    const unsigned tails = c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
    out += static_cast<char>((0xff00u >> (tails + 1) & 0xff) | c >> 6 * tails);
    for (unsigned i = tails; i > 0; --i) tail(6 * (i - 1));
  }
  return out;
}

/// The one character that two are; 0: there is none.
char32_t pair_of(char32_t base, char32_t mark) {
  if (base >= kLead && base < kLead + 19 && mark >= kVowel && mark < kVowel + 21)
    return kSyllables + (base - kLead) * kOfLead + (mark - kVowel) * kTails;
  const bool open = base >= kSyllables && base < kSyllablesEnd && (base - kSyllables) % kTails == 0;
  if (open && mark > kTail && mark < kTail + kTails) return base + (mark - kTail);
  if (mark < 0x300) return 0;
  const auto* const found = std::ranges::find_if(
      kLetterParts, [&](const LetterParts& parts) { return parts.base == base && parts.mark == mark; });
  return found == std::end(kLetterParts) ? 0 : found->letter;
}

}  // namespace

std::string taken_apart(std::string_view text) { return utf8(decomposed(text)); }

std::string put_together(std::string_view text) {
  std::u32string out;
  for (const char32_t c : decomposed(text)) {
    const char32_t both = out.empty() ? 0 : pair_of(out.back(), c);
    if (both != 0) {
      out.back() = both;
    } else {
      out += c;
    }
  }
  return utf8(out);
}

std::u32string decomposed(std::string_view text) {
  std::u32string out;
  while (!text.empty()) put_parts(out, take_character(text));
  return out;
}

bool same_letters(std::string_view a, std::string_view b) { return a == b || decomposed(a) == decomposed(b); }

}  // namespace afterglow
