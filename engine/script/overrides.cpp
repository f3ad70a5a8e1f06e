#include "script/overrides.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/text.h"
#include "script/injection.h"
#include "script/setting.h"

namespace afterglow {

Result<Override> parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t dot = text.find('.');
  if (equals == std::string::npos || dot >= equals || dot == 0 || dot + 1 == equals)
    return Error{ErrorKind::usage, fmt::format("--set '{}' is no override", script::tidy_message(text, 100)), "", 0,
                 "ENTRY.SETTING=VALUE"};
  return Override{trim(text.substr(0, dot)), trim(text.substr(dot + 1, equals - dot - 1)), text.substr(equals + 1)};
}

namespace script {

SettingSchema entry_key_schema(const std::string& name) {
  SettingSchema schema;
  schema.name = name;
  if (name == "enabled") schema.type = SettingType::boolean;
  if (name == "order") {
    schema.type = SettingType::integer;
    schema.min = -1e6;
    schema.max = 1e6;
  }
  if (name == "opacity") {
    schema.min = 0;
    schema.max = 1;
    schema.default_value.number[0] = 1;
  }
  if (name == "blend") {
    schema.type = SettingType::enumeration;
    schema.choices = blend_modes();
  }
  if (name == "at") {
    schema.type = SettingType::enumeration;
    schema.choices = injection_points();
  }
  return schema;
}

namespace {

constexpr std::string_view kCommandLine = "--set ";
constexpr std::array kKeys{"at", "blend", "enabled", "opacity", "order"};  // that --set knows besides settings

// Whoever gives commands may name any file; names of scripts go along the search path.
std::optional<SettingValue> named_file(const std::string& text, const SettingSchema& schema) {
  std::error_code ec;
  const std::filesystem::path file(parse_value(text).text);
  if (file.empty() || !has_extension(schema, file.string()) || !std::filesystem::is_regular_file(file, ec)) return {};
  return SettingValue{SettingType::file, {1}, std::filesystem::absolute(file, ec).string()};
}

}  // namespace

Result<SettingValue> parse_value_of(const std::string& text, const SettingSchema& schema, const std::string& full_name,
                                    bool any_file) {
  Value value = parse_value(text);
  // A choice may look like something else: `mode=2d`, `mode=true`.
  if (schema.type == SettingType::enumeration && value.kind != Value::Kind::text) {
    value.kind = Value::Kind::text;
    value.text = trim(text);
  }
  if (schema.type == SettingType::text && value.kind != Value::Kind::text) {
    value.kind = Value::Kind::text;
    value.text = text;
  }
  if (schema.type == SettingType::file) {
    if (any_file)
      if (auto file = named_file(text, schema)) return *file;
    value.kind = Value::Kind::text;
    value.text = trim(text);
  }
  auto result = check_setting(full_name, schema, value);
  if (result) return result;
  Error error = result.error();
  error.kind = ErrorKind::usage;
  return error;
}

Result<SettingValue> parse_setting(const Override& given, const SettingSchema& schema, std::string_view where) {
  return parse_value_of(given.value, schema, fmt::format("{}{}.{}", where, given.entry, given.setting),
                        where == kCommandLine);
}

namespace {

Result<void> apply(DeclaredEntry& declared, const Override& given, const EffectSchema& schema) {
  StackEntry& entry = declared.entry;
  const auto found = std::find_if(schema.settings.begin(), schema.settings.end(),
                                  [&](const auto& s) { return s.name == given.setting; });
  if (found != schema.settings.end()) {
    AFTERGLOW_TRY(SettingValue value, parse_setting(given, *found, kCommandLine));
    declared.sources[static_cast<std::size_t>(found - schema.settings.begin())].overridden = std::move(value);
    return {};
  }
  if (std::ranges::find(kKeys, given.setting) != kKeys.end()) {
    AFTERGLOW_TRY(const SettingValue value, parse_setting(given, entry_key_schema(given.setting), kCommandLine));
    if (given.setting == "enabled") entry.enabled = value.number[0] != 0;
    if (given.setting == "order") entry.order = static_cast<int>(value.number[0]);
    if (given.setting == "at") entry.at = value.choice;
    if (given.setting == "order" || given.setting == "at") declared.placed = true;
    if (given.setting == "blend") entry.blend = value.choice;
    if (given.setting == "opacity") declared.opacity = Animated{.fixed = value, .curve = {}, .function = {}};
    return {};
  }
  std::vector<std::string> names;
  for (const auto& setting : schema.settings) names.push_back(setting.name);
  for (const char* key : kKeys) names.emplace_back(key);
  return Error{ErrorKind::usage,
               fmt::format("--set {}.{}: effect '{}' has no such setting", given.entry, given.setting, schema.name),
               "",
               0,
               join(names),
               nearest_name(given.setting, names)};
}

Result<void> apply_everywhere(std::vector<DeclaredEntry>& entries, const Override& given,
                              const std::deque<Effect>& effects) {
  const auto named = [&](const DeclaredEntry& e) { return e.entry.name == given.entry; };
  const bool by_name = std::any_of(entries.begin(), entries.end(), named);
  bool found = false;
  std::vector<std::string> names;
  for (auto& declared : entries) {
    names.push_back(declared.entry.name);
    if (by_name ? !named(declared) : declared.entry.effect != given.entry) continue;
    found = true;
    AFTERGLOW_CHECK(apply(declared, given, effects[static_cast<std::size_t>(declared.effect)].schema));
  }
  if (found) return {};
  return Error{ErrorKind::usage,
               fmt::format("--set {}.{}: the stack has no entry '{}'", given.entry, given.setting, given.entry),
               "",
               0,
               join(names),
               nearest_name(given.entry, names)};
}

}  // namespace

Result<void> apply_overrides(std::vector<DeclaredEntry>& entries, const std::vector<Override>& overrides,
                             const std::deque<Effect>& effects, Diagnostics* left_out) {
  for (const auto& given : overrides) {
    auto applied = apply_everywhere(entries, given, effects);
    if (applied) continue;
    if (!left_out) return applied;
    Error error = std::move(applied).error();
    error.message += "; it is left out";
    std::string text = error.text();
    if (text.starts_with("error: ")) text.erase(0, 7);
    left_out->warn(text);
  }
  return {};
}

}  // namespace script
}  // namespace afterglow
