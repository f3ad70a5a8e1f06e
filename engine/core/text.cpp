// SPDX-License-Identifier: MIT
#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/printable.h"
#include "core/utf8.h"

namespace afterglow {
namespace {

/// Letters that are wrong, missing, too many, or changed over with the next one ("optimal string alignment").
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1), above(row), two_above(row);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    two_above.swap(above);
    above.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j - 1] + (a[i - 1] != b[j - 1]), above[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], two_above[j - 2] + 1);
    }
  }
  return row.back();
}

/// Letters and digits alone, in lower case.
std::string squeezed(std::string_view name) {
  std::string out = lower(name);
  std::erase_if(out, [](unsigned char c) { return !std::isalnum(c); });
  return out;
}

/// Of what says nothing about the name: the extension that both have.
std::size_t length_of_ending(std::string_view a, std::string_view b) {
  const std::size_t dot = a.rfind('.');
  return dot != std::string_view::npos && b.ends_with(a.substr(dot)) ? a.size() - dot : 0;
}

/// The shortest candidate that begins with the name, or else holds it: "tonemap", "grain".
std::string longer_name(std::string_view name, std::span<const std::string> candidates) {
  constexpr std::size_t kLeast = 3, kLeastInside = 4;  // letters that say what is meant
  const std::string wanted = squeezed(name);
  const std::string* best = nullptr;
  bool best_begins = false;
  for (const auto& candidate : candidates) {
    const std::size_t at = wanted.size() < kLeast ? std::string::npos : squeezed(candidate).find(wanted);
    const bool begins = at == 0;
    if (at == std::string::npos || (!begins && (wanted.size() < kLeastInside || best_begins))) continue;
    if (best && begins == best_begins && candidate.size() >= best->size()) continue;
    best = &candidate;
    best_begins = begins;
  }
  return best ? *best : std::string();
}

}  // namespace

std::string nearest_name(std::string_view name, std::span<const std::string> candidates) {
  if (name.empty() || name.size() > 256) return {};
  std::string best;
  std::size_t best_distance = std::string::npos;
  for (const auto& candidate : candidates) {
    const std::size_t distance = edit_distance(lower(name), lower(candidate));
    const std::size_t same = length_of_ending(name, candidate);
    const std::size_t limit = (std::max(name.size(), candidate.size()) - same + 1) / 3;
    if (distance <= limit && distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best.empty() ? longer_name(name, candidates) : best;
}

std::string join(std::span<const std::string> parts, std::string_view separator) {
  return fmt::format("{}", fmt::join(parts, separator));
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = text.find(separator, begin);
    parts.emplace_back(text.substr(begin, end - begin));
    if (end == std::string_view::npos) return parts;
    begin = end + 1;
  }
}

bool starts_with_any(std::string_view text, std::span<const std::string_view> prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(), [&](auto p) { return text.starts_with(p); });
}

std::string trim(std::string_view text) {
  const auto is_space = [](unsigned char c) { return std::isspace(c) != 0; };
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return std::string(text);
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return std::tolower(c); });
  return out;
}

std::string markup_text(std::string_view text) {
  std::string out;
  for (const char c : printable(utf8_text(std::string(text)), true))
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  return out;
}

std::string number_text(double value) {
  if (!std::isfinite(value)) return fmt::format("{}", value);
  // A setting that came as 0.2 must print as 0.2 whether it was kept as a float or as a double.
  const std::string as_double = fmt::format("{}", value);
  if (std::abs(value) > std::numeric_limits<float>::max()) return as_double;
  const float rounded = static_cast<float>(value);
  if (rounded == 0 && value != 0) return as_double;
  const std::string as_float = fmt::format("{}", rounded);
  return as_double.size() <= as_float.size() ? as_double : as_float;
}

std::string memory_text(std::uint64_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (value >= 1024.0 * 1024 * 1024) return fmt::format("{:.1f} GiB", value / (1024.0 * 1024 * 1024));
  if (value >= 1024.0 * 1024) return fmt::format("{:.0f} MiB", value / (1024.0 * 1024));
  if (value >= 1024.0) return fmt::format("{:.0f} KiB", value / 1024.0);
  return fmt::format("{} byte{}", bytes, bytes == 1 ? "" : "s");
}

}  // namespace afterglow
