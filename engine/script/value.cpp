// SPDX-License-Identifier: MIT
#include "script/value.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "core/text.h"
#include "script/read_only.h"
#include "script/script_error.h"

namespace afterglow::script {
namespace {

bool parse_number(std::string_view text, double& number) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

bool parse_list(std::string text, Value& value) {
  if (text.starts_with('{') && text.ends_with('}')) text = text.substr(1, text.size() - 2);
  const auto parts = split(text, ',');
  if (parts.size() < 2 || parts.size() > value.list.size()) return false;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (!parse_number(trim(parts[i]), value.list[i])) return false;
  value.count = static_cast<int>(parts.size());
  return true;
}

// Numbers that no 32-bit float holds are shown as they are, and not as infinite.
std::string shown_number(double value) {
  return std::isfinite(value) && !std::isfinite(static_cast<float>(value)) ? fmt::format("{}", value)
                                                                           : number_text(value);
}

}  // namespace

std::string Value::shown() const {
  switch (kind) {
    case Kind::nothing:
      return "nil";
    case Kind::boolean:
      return number != 0 ? "true" : "false";
    case Kind::number:
      return shown_number(number);
    case Kind::text:
      return '"' + tidy_message(text, 60) + '"';
    case Kind::other:
      return text;
    case Kind::list:
      break;
  }
  std::string out = "{";
  for (int i = 0; i < count; ++i) out += (i ? ", " : "") + shown_number(list[static_cast<std::size_t>(i)]);
  return out + "}";
}

Value read_value(lua_State* lua, int index) {
  Value value;
  const int type = lua_type(lua, index);
  switch (type) {
    case LUA_TNONE:
    case LUA_TNIL:
      return value;
    case LUA_TBOOLEAN:
      value.kind = Value::Kind::boolean;
      value.number = lua_toboolean(lua, index);
      return value;
    case LUA_TNUMBER:
      value.kind = Value::Kind::number;
      value.number = lua_tonumber(lua, index);
      return value;
    case LUA_TSTRING: {
      value.kind = Value::Kind::text;
      std::size_t size = 0;
      const char* text = lua_tolstring(lua, index, &size);
      value.text.assign(text, std::min(size, kLongestText + 1));
      return value;
    }
    default:
      break;
  }
  value.kind = Value::Kind::other;
  value.text = kind_name(lua, index);
  value.text.insert(0, std::string_view("aeiou").find(value.text[0]) == std::string_view::npos ? "a " : "an ");
  if (type != LUA_TTABLE) return value;
  push_real(lua, index);
  const auto size = lua_rawlen(lua, -1);
  bool numbers = size >= 1 && size <= value.list.size();
  for (std::size_t i = 0; numbers && i < size; ++i) {
    numbers = lua_rawgeti(lua, -1, static_cast<lua_Integer>(i + 1)) == LUA_TNUMBER;
    value.list[i] = lua_tonumber(lua, -1);
    lua_pop(lua, 1);
  }
  lua_pop(lua, 1);
  if (numbers) {
    value.kind = Value::Kind::list;
    value.count = static_cast<int>(size);
  }
  return value;
}

std::string kind_name(lua_State* lua, int index) {
  std::string name = luaL_typename(lua, index);
  if (lua_type(lua, index) == LUA_TUSERDATA && luaL_getmetafield(lua, index, "__name") != LUA_TNIL) {
    if (lua_type(lua, -1) == LUA_TSTRING) name = lua_tostring(lua, -1);
    lua_pop(lua, 1);
  }
  return name;
}

Value parse_value(const std::string& given) {
  Value value;
  const std::string text = trim(given);
  if (text == "true" || text == "false") {
    value.kind = Value::Kind::boolean;
    value.number = text == "true";
  } else if (parse_number(text, value.number)) {
    value.kind = Value::Kind::number;
  } else if (parse_list(text, value)) {
    value.kind = Value::Kind::list;
  } else {
    value.kind = Value::Kind::text;
    // One text within quotation marks; not two that have theirs.
    const bool quoted =
        text.size() >= 2 && (text[0] == '"' || text[0] == '\'') && text.find(text[0], 1) + 1 == text.size();
    value.text = quoted ? text.substr(1, text.size() - 2) : text;
  }
  return value;
}

}  // namespace afterglow::script
