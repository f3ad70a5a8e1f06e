// SPDX-License-Identifier: MIT
#include "script/setting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/near_path.h"
#include "core/text.h"
#include "image/srgb.h"
#include "script/read_only.h"

namespace afterglow {
namespace {

std::string list_text(const SettingValue& value, int count) {
  std::string out = "{";
  for (int i = 0; i < count; ++i) out += (i ? ", " : "") + number_text(value.number[static_cast<std::size_t>(i)]);
  return out + "}";
}

/// So that `parse_value` finds the same text: within quotation marks that it has not, else as it is.
std::string quoted(const std::string& text) {
  for (const char mark : {'"', '\''})
    if (text.find(mark) == std::string::npos) return mark + text + mark;
  return text;
}

}  // namespace

std::string SettingValue::text() const {
  switch (type) {
    case SettingType::integer:
      return fmt::format("{}", static_cast<long long>(number[0]));
    case SettingType::number:
      return number_text(number[0]);
    case SettingType::boolean:
      return number[0] != 0 ? "true" : "false";
    case SettingType::enumeration:
    case SettingType::file:
    case SettingType::text:
      return quoted(choice);
    case SettingType::color:
      if (const auto code = script::shorter_color(*this)) return '"' + *code + '"';
      return list_text(*this, 3);
    case SettingType::vec2:
      return list_text(*this, 2);
    case SettingType::vec3:
      return list_text(*this, 3);
  }
  return {};
}

namespace script {
namespace {

constexpr double kMaxInteger = 2147483647;

/// The value within the bounds. What goes beyond one by no more than a 32-bit float's rounding (of the bound, or of 1)
/// is the bound, as of sums of animated values: 0.05 + 0.9 is more than 0.95, 0.3 − 0.1·3 less than 0. None: out of
/// range. Whole numbers are exact. Colours have a bound of their own, 0.
std::optional<double> within(const SettingSchema& schema, double value) {
  const auto slack = [&](double bound) {
    return schema.type == SettingType::integer ? 0 : 6e-8 * std::max(std::abs(bound), 1.0);
  };
  std::optional<double> min = schema.min;
  if (schema.type == SettingType::color) min = std::max(min.value_or(0), 0.0);
  if (min && value < *min) return *min - value <= slack(*min) ? min : std::nullopt;
  if (schema.max && value > *schema.max) return value - *schema.max <= slack(*schema.max) ? schema.max : std::nullopt;
  return value;
}

// Shaders get 32-bit floats.
constexpr const char* kTooLarge = "larger than a 32-bit float holds";
bool fits_float(double value) { return std::isfinite(static_cast<float>(value)); }

bool parse_hex_color(const std::string& text, SettingValue& value) {
  if (text.size() != 7 || text[0] != '#') return false;
  if (text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos) return false;
  for (std::size_t i = 0; i < 3; ++i)
    value.number[i] = srgb_to_linear(std::stoi(text.substr(1 + 2 * i, 2), nullptr, 16) / 255.0);
  return true;
}

}  // namespace

std::string range_text(const SettingSchema& schema) {
  if (schema.min && schema.max) return number_text(*schema.min) + "…" + number_text(*schema.max);
  if (schema.min) return "≥ " + number_text(*schema.min);
  if (schema.max) return "≤ " + number_text(*schema.max);
  return {};
}

bool has_extension(const SettingSchema& schema, const std::string& file) {
  const std::string name = lower(file);
  return std::ranges::any_of(schema.choices, [&](const auto& extension) { return name.ends_with("." + extension); });
}

std::optional<std::string> hex_color(const SettingValue& color) {
  std::string text = "#";
  for (const double c : color.number) {
    if (!(c >= 0 && c <= 1)) return {};
    const int code = static_cast<int>(std::lround(linear_to_srgb(c) * 255));
    if (static_cast<float>(srgb_to_linear(code / 255.0)) != static_cast<float>(c)) return {};
    text += fmt::format("{:02x}", code);
  }
  return text;
}

std::optional<std::string> shorter_color(const SettingValue& color) {
  constexpr std::size_t kLong = 9;
  const bool many = std::ranges::any_of(color.number, [](double v) { return number_text(v).size() >= kLong; });
  return many ? hex_color(color) : std::nullopt;
}

const char* type_name(SettingType type) {
  static constexpr const char* kNames[] = {"integer", "number", "boolean", "choice", "colour",
                                           "vec2",    "vec3",   "file",    "text"};
  return kNames[static_cast<int>(type)];
}

std::string allowed_text(const SettingSchema& schema) {
  const std::string range = range_text(schema);
  switch (schema.type) {
    case SettingType::integer:
      return range.empty() ? "an integer" : "integer " + range;
    case SettingType::number:
      return range.empty() ? "a number" : range;
    case SettingType::boolean:
      return "true, false";
    case SettingType::enumeration:
      return join(schema.choices);
    case SettingType::color:
      return "{r, g, b} with numbers ≥ 0, \"#rrggbb\"";
    case SettingType::vec2:
      return range.empty() ? "{x, y}" : "{x, y}, each " + range;
    case SettingType::vec3:
      return range.empty() ? "{x, y, z}" : "{x, y, z}, each " + range;
    case SettingType::file:
      return "\"\" for none, the name of a file beside the preset or on the search path: ." +
             join(schema.choices, ", .");
    case SettingType::text:
      return fmt::format("a text of at most {} bytes", kLongestText);
  }
  return {};
}

Result<SettingValue> check_setting(const std::string& full_name, const SettingSchema& schema, const Value& given) {
  using Kind = Value::Kind;
  const auto fail = [&](const char* what, std::string nearest = {}) {
    return Error{
        ErrorKind::script, fmt::format("{} = {} is {}", full_name, given.shown(), what), "", 0, allowed_text(schema),
        std::move(nearest)};
  };
  SettingValue value;
  value.type = schema.type;
  switch (schema.type) {
    case SettingType::integer:
    case SettingType::number: {
      const bool integer = schema.type == SettingType::integer;
      if (given.kind != Kind::number) return fail(integer ? "not an integer" : "not a number");
      if (!std::isfinite(given.number)) return fail("not finite");
      if (integer && given.number != std::floor(given.number)) return fail("not an integer");
      const auto held = within(schema, given.number);
      if (!held || (integer && std::abs(*held) > kMaxInteger)) return fail("out of range");
      if (!fits_float(*held)) return fail(kTooLarge);
      value.number[0] = *held + 0.0;  // −0 becomes 0
      return value;
    }
    case SettingType::boolean:
      if (given.kind != Kind::boolean) return fail("not a boolean");
      value.number[0] = given.number;
      return value;
    case SettingType::enumeration:
      if (given.kind != Kind::text) return fail("not a choice");
      for (const auto& choice : schema.choices)
        if (choice == given.text) {
          value.choice = choice;
          return value;
        }
      return fail("not a choice", nearest_name(given.text, schema.choices));
    case SettingType::text:
      if (given.kind != Kind::text) return fail("not a text");
      if (given.text.size() > kLongestText) return fail("too long");
      value.choice = given.text;
      return value;
    case SettingType::file:
      if (given.kind != Kind::text) return fail("not the name of a file");
      value.choice = given.text;
      if (given.text.empty()) return value;
      if (!is_tidy_path(given.text)) {
        const std::string tidy = tidy_path(given.text);
        return tidy.empty() ? fail("not a name inside of the folders that scripts may read")
                            : fail("not how scripts name a file", tidy);
      }
      if (!has_extension(schema, given.text)) return fail("no file of a kind that is allowed");
      return value;
    case SettingType::color:
    case SettingType::vec2:
    case SettingType::vec3: {
      const bool color = schema.type == SettingType::color;
      if (color && given.kind == Kind::text && parse_hex_color(given.text, value)) return value;
      if (given.kind != Kind::list || given.count != (schema.type == SettingType::vec2 ? 2 : 3))
        return fail(color ? "not a colour" : schema.type == SettingType::vec2 ? "not a vec2" : "not a vec3");
      for (int i = 0; i < given.count; ++i) {
        const double c = given.list[static_cast<std::size_t>(i)];
        if (!std::isfinite(c)) return fail("not finite");
        const auto held = within(schema, c);
        if (!held) return fail("out of range");
        if (!fits_float(*held)) return fail(kTooLarge);
        value.number[static_cast<std::size_t>(i)] = *held + 0.0;
      }
      return value;
    }
  }
  return fail("of no known type");
}

void push_setting(lua_State* lua, const SettingValue& value) {
  switch (value.type) {
    case SettingType::integer:
      lua_pushinteger(lua, static_cast<lua_Integer>(value.number[0]));
      return;
    case SettingType::number:
      lua_pushnumber(lua, value.number[0]);
      return;
    case SettingType::boolean:
      lua_pushboolean(lua, value.number[0] != 0);
      return;
    case SettingType::enumeration:
    case SettingType::file:
    case SettingType::text:
      lua_pushlstring(lua, value.choice.data(), value.choice.size());
      return;
    case SettingType::color:
    case SettingType::vec2:
    case SettingType::vec3:
      break;
  }
  const int count = value.type == SettingType::vec2 ? 2 : 3;
  lua_createtable(lua, count, 0);
  for (int i = 0; i < count; ++i) {
    lua_pushnumber(lua, value.number[static_cast<std::size_t>(i)]);
    lua_rawseti(lua, -2, i + 1);
  }
  make_read_only(lua);
}

Result<void> check_value(const std::string& full_name, const SettingSchema& schema, const SettingValue& value) {
  Value given;
  given.kind = Value::Kind::list;
  given.count = value.type == SettingType::vec2 ? 2 : 3;
  std::copy(value.number.begin(), value.number.end(), given.list.begin());
  given.number = value.number[0];
  given.text = value.choice;
  if (value.type == SettingType::enumeration || value.type == SettingType::file || value.type == SettingType::text)
    given.kind = Value::Kind::text;
  if (value.type == SettingType::boolean) given.kind = Value::Kind::boolean;
  if (value.type == SettingType::integer || value.type == SettingType::number) given.kind = Value::Kind::number;
  auto checked = check_setting(full_name, schema, given);
  if (checked) return {};
  Error error = checked.error();
  error.kind = ErrorKind::usage;
  return error;
}

}  // namespace script
}  // namespace afterglow
