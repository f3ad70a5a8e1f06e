// SPDX-License-Identifier: MIT
#include "script/requirement.h"

#include <charconv>

#include "core/lua_text.h"
#include "core/text.h"

namespace afterglow::script {
namespace {

constexpr std::string_view kKey = "requires";

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
  const LuaText script(text);
  for (std::size_t i = 0; i + 2 < script.size(); ++i) {
    if (!script.is(i, kKey) || !script.is(i + 1, "=")) continue;
    const Token& value = script[i + 2];
    const std::string_view wanted = value.kind == TokenKind::text ? value.inside() : std::string_view();
    const auto version = parse_version(wanted);
    if (version && *version > own) return Requirement{std::string(wanted), script[i].line};
  }
  return {};
}

}  // namespace afterglow::script
