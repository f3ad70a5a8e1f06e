// SPDX-License-Identifier: MIT
#include "script/requirement.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "core/ascii.h"
#include "core/text.h"

namespace afterglow::script {
namespace {

constexpr std::string_view kKey = "requires";

/// The text in quotation marks behind `key =`; empty: there is none.
std::string_view quoted_behind(std::string_view rest) {
  const auto skip = [&] {
    while (!rest.empty() && std::isspace(static_cast<unsigned char>(rest.front()))) rest.remove_prefix(1);
  };
  skip();
  if (!rest.starts_with('=')) return {};
  rest.remove_prefix(1);
  skip();
  if (rest.empty() || (rest.front() != '"' && rest.front() != '\'')) return {};
  const std::size_t end = rest.find(rest.front(), 1);
  return end == std::string_view::npos ? std::string_view() : rest.substr(1, end - 1);
}

}  // namespace

std::optional<Version> parse_version(std::string_view text) {
  Version version{};
  std::size_t parts = 0;
  for (const auto& part : split(text, '.')) {
    if (parts == version.size()) return {};
    int& number = version[parts++];
    const auto [end, problem] = std::from_chars(part.data(), part.data() + part.size(), number);
    if (part.empty() || problem != std::errc() || end != part.data() + part.size() || number < 0) return {};
  }
  return parts >= 2 ? std::optional(version) : std::nullopt;
}

std::optional<Requirement> newer_requirement(std::string_view text, const Version& own) {
  int line = 0;
  while (!text.empty()) {
    ++line;
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view code = text.substr(0, std::min(text.find("--"), end));
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t at = code.find(kKey);
    if (at == std::string_view::npos || (at > 0 && is_name_char(code[at - 1]))) continue;
    const std::string_view wanted = quoted_behind(code.substr(at + kKey.size()));
    const auto version = parse_version(wanted);
    if (version && *version > own) return Requirement{std::string(wanted), line};
  }
  return {};
}

}  // namespace afterglow::script
