// SPDX-License-Identifier: MIT
#include "window/error_lines.h"

#include <algorithm>
#include <string_view>

#include "core/ascii.h"
#include "core/parse_number.h"

namespace afterglow {
namespace {

/// Of text that begins with a line's number: how many digits it has.
std::size_t number_length(std::string_view text) {
  const auto end = std::ranges::find_if_not(text, is_digit);
  return static_cast<std::size_t>(end - text.begin());
}

/// "FILE:LINE: MESSAGE", "included at FILE:LINE", "in effect 'glow' of FILE:LINE". A file's name may have colons and
/// spaces, so that the first number between colons, or the one at the end, is the line's.
ErrorLine parsed(const std::string& text) {
  for (std::size_t colon = text.find(':'); colon != std::string::npos; colon = text.find(':', colon + 1)) {
    const std::string_view behind = std::string_view(text).substr(colon + 1);
    const std::size_t digits = number_length(behind);
    const auto line = parse_number<int>(behind.substr(0, digits));
    if (colon == 0 || !line || *line <= 0) continue;
    if (behind.substr(digits).starts_with(": ")) {
      const std::string file = text.substr(0, colon);
      return {text.substr(0, colon + 1 + digits), text.substr(colon + 1 + digits + 2), {file, *line}};
    }
    if (digits != behind.size()) continue;
    for (const std::string_view word : {"included at ", " of "})
      if (const auto at = text.find(word); at != std::string::npos && at < colon)
        return {"", text, {text.substr(at + word.size(), colon - at - word.size()), *line}};
  }
  return {"", text, {}};
}

}  // namespace

std::vector<ErrorLine> further_lines(const Error& error) {
  std::vector<ErrorLine> out;
  for (const std::string& text : error.trail) out.push_back(parsed(text));
  return out;
}

std::vector<ErrorPlace> error_places(const Error& error) {
  std::vector<ErrorPlace> out;
  const auto add = [&](const ErrorPlace& place) {
    const auto same = [&](const ErrorPlace& one) { return one.file == place.file && one.line == place.line; };
    if (!place.file.empty() && std::ranges::none_of(out, same)) out.push_back(place);
  };
  add({error.file, error.line});
  for (const ErrorLine& line : further_lines(error)) add(line.place);
  return out;
}

}  // namespace afterglow
