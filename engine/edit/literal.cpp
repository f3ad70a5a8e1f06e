// SPDX-License-Identifier: MIT
#include "edit/literal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/text.h"
#include "script/schema.h"

namespace afterglow::script {
namespace {

// Numbers that came from 32-bit floats are written as those: 0.1, not 0.10000000149.
std::string decimal_text(double value) {
  const auto narrow = static_cast<float>(value);
  if (std::isfinite(narrow) && static_cast<double>(narrow) == value) return number_text(value);
  return fmt::format("{}", value);
}

bool has(std::string_view text, char a) { return text.find(a) != std::string_view::npos; }

// Zeros behind the point, where the old number was written with more than it needed: 1.0, 0.50.
std::string padded(std::string number, std::string_view old) {
  const std::size_t point = old.find('.');
  if (point == std::string_view::npos || old.back() != '0' || has(number, 'e') || has(old, 'e') || has(old, 'E'))
    return number;
  const std::size_t wanted = old.size() - point - 1;
  if (!has(number, '.')) number += '.';
  const std::size_t digits = number.size() - number.find('.') - 1;
  if (digits < wanted) number.append(wanted - digits, '0');
  return number;
}

// One digit before the point: 2000 as 2e3. The value is positive.
std::string with_exponent(double value, char letter) {
  const std::string text = decimal_text(value);
  const std::size_t e = std::min(text.find('e'), text.size());
  int exponent = e < text.size() ? std::stoi(text.substr(e + 1)) : 0;
  std::string digits = text.substr(0, e);
  const std::size_t point = std::min(digits.find('.'), digits.size());
  exponent += static_cast<int>(point) - 1;
  digits.erase(point, 1);
  const std::size_t zeros = digits.find_first_not_of('0');
  exponent -= static_cast<int>(zeros);
  digits.erase(0, zeros);
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.size() > 1) digits.insert(1, ".");
  return fmt::format("{}{}{}", digits, letter, exponent);
}

std::string number_like(std::string_view old, double value) {
  const bool negative = value < 0;
  const double size = std::abs(value);
  std::string text;
  if (old.starts_with("0x") || old.starts_with("0X")) {
    if (size == std::floor(size) && size < 9e15) {
      const bool upper = old.find_first_of("ABCDEF") != std::string_view::npos;
      const auto whole = static_cast<unsigned long long>(size);
      text = std::string(old.substr(0, 2)) + (upper ? fmt::format("{:X}", whole) : fmt::format("{:x}", whole));
      while (text.size() < old.size() && !has(old, '.') && !has(old, 'p')) text.insert(2, "0");
    } else {
      text = decimal_text(size);
    }
  } else if ((has(old, 'e') || has(old, 'E')) && size > 0 && (size >= 1000 || size < 0.001)) {
    text = with_exponent(size, has(old, 'E') ? 'E' : 'e');
  } else {
    text = padded(decimal_text(size), old);
    if (old.starts_with('.') && text.starts_with("0.")) text.erase(0, 1);
  }
  return negative ? "-" + text : text;
}

std::string quoted(std::string_view old, const std::string& content) {
  if (old.starts_with('[') && !has(content, ']') && !has(content, '\n') && !has(content, '\r')) {
    const std::size_t opening = old.find('[', 1) + 1;
    return std::string(old.substr(0, opening)) + content + std::string(old.substr(old.size() - opening));
  }
  const char quote = old.starts_with('\'') ? '\'' : '"';
  std::string out(1, quote);
  for (const char c : content) {
    if (c == '\n' || c == '\t') {
      out += c == '\n' ? "\\n" : "\\t";
      continue;
    }
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      out += fmt::format("\\{:03}", static_cast<int>(static_cast<unsigned char>(c)));
      continue;
    }
    if (c == quote || c == '\\') out += '\\';
    out += c;
  }
  return out + quote;
}

// The number at token i, with its sign; the token behind it, or kNone when there is none.
std::size_t number_end(const LuaText& text, std::size_t i) {
  if (text.is(i, "-")) ++i;
  return i < text.size() && text[i].kind == TokenKind::number ? i + 1 : LuaText::kNone;
}

// First tokens of the numbers of a list; empty when it holds anything else.
std::vector<std::size_t> list_numbers(const LuaText& text, std::size_t first, std::size_t end) {
  std::vector<std::size_t> out;
  if (!text.is(first, "{") || text.partner(first) == LuaText::kNone || text.partner(first) + 1 != end) return out;
  for (const auto& item : text.items(first)) {
    if (item.first != item.value || number_end(text, item.value) != item.end) return {};
    out.push_back(item.value);
  }
  return out;
}

// The numbers are replaced where they stand: spaces, line breaks and comments of the list stay.
std::string list_like(const LuaText& text, const std::vector<std::size_t>& numbers, std::size_t first, std::size_t end,
                      const SettingValue& value) {
  std::string out;
  std::size_t at = text[first].begin;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t last = number_end(text, numbers[i]) - 1;
    out += text.text().substr(at, text[numbers[i]].begin - at);
    out += number_like(text[last].text, value.number[i]);
    at = text[last].end();
  }
  return out + std::string(text.text().substr(at, text[end - 1].end() - at));
}

}  // namespace

bool is_literal(const LuaText& text, std::size_t first, std::size_t end) {
  if (first >= end || end > text.size()) return false;
  if (number_end(text, first) == end) return true;
  if (end == first + 1)
    return text[first].kind == TokenKind::text || text.is(first, "true") || text.is(first, "false") ||
           text.is(first, "nil");
  return !list_numbers(text, first, end).empty();
}

std::string literal_like(const LuaText& text, std::size_t first, std::size_t end, const SettingValue& value) {
  const Token& old = text[first];
  const bool is_text = old.kind == TokenKind::text;
  switch (value.type) {
    case SettingType::integer:
    case SettingType::number:
      if (number_end(text, first) == end) return number_like(text[end - 1].text, value.number[0]);
      break;
    case SettingType::enumeration:
    case SettingType::file:
    case SettingType::text:
      if (is_text) return quoted(old.text, value.choice);
      break;
    case SettingType::color:
      if (const auto hex = is_text ? hex_color(value) : std::nullopt) {
        const bool upper = old.inside().find_first_of("ABCDEF") != std::string_view::npos;
        std::string code = *hex;
        if (upper)
          for (char& c : code) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        return quoted(old.text, code);
      }
      if (shorter_color(value)) break;
      [[fallthrough]];
    case SettingType::vec2:
    case SettingType::vec3: {
      const auto numbers = list_numbers(text, first, end);
      if (numbers.size() == number_count(value.type)) return list_like(text, numbers, first, end, value);
      break;
    }
    case SettingType::boolean:
      break;
  }
  return literal_text(value);
}

std::string literal_text(const SettingValue& value, char quote, bool spaced) {
  switch (value.type) {
    case SettingType::integer:
      return fmt::format("{}", static_cast<long long>(value.number[0]));
    case SettingType::number:
      return decimal_text(value.number[0]);
    case SettingType::boolean:
      return value.number[0] != 0 ? "true" : "false";
    case SettingType::enumeration:
    case SettingType::file:
    case SettingType::text:
      return quoted(std::string(1, quote), value.choice);
    case SettingType::color:
      if (const auto code = shorter_color(value)) return quoted(std::string(1, quote), *code);
      break;
    case SettingType::vec2:
    case SettingType::vec3:
      break;
  }
  std::string out;
  for (std::size_t i = 0; i < number_count(value.type); ++i) out += (i > 0 ? ", " : "") + decimal_text(value.number[i]);
  return spaced ? "{ " + out + " }" : "{" + out + "}";
}

}  // namespace afterglow::script
