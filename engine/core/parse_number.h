// SPDX-License-Identifier: MIT
// Numbers as words.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace afterglow {

/// The number that the whole text is, without spaces and without a plus sign; nothing when it is none, or does not fit.
/// `form`: the base of integers.
template <class Number>
std::optional<Number> parse_number(std::string_view text, auto... form) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value, form...);
  return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

}  // namespace afterglow
