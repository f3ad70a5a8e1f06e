// SPDX-License-Identifier: MIT
#include "shader/literal.h"

#include <charconv>
#include <string>
#include <system_error>

namespace afterglow {

std::optional<double> literal_value(const Token& token, ParamType type) {
  if (type == ParamType::bool1) {
    if (token.is("true")) return 1.0;
    if (token.is("false")) return 0.0;
    return std::nullopt;
  }
  if (token.kind != TokenKind::number) return std::nullopt;
  std::string text(token.text);
  if (type == ParamType::int1) {
    const bool hex = text.starts_with("0x") || text.starts_with("0X");
    if (hex) text.erase(0, 2);
    int value = 0;
    const int base = hex ? 16 : text.starts_with('0') ? 8 : 10;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
  }
  while (text.size() > 1 && (text.back() == 'f' || text.back() == 'F')) text.pop_back();
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace afterglow
