#include "script/overrides.h"

#include <fmt/format.h>

#include <algorithm>

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
  if (name == "at") {
    schema.type = SettingType::enumeration;
    schema.choices = injection_points();
  }
  return schema;
}

namespace {

constexpr std::string_view kCommandLine = "--set ";

// Whoever gives commands may name any file; names of scripts go along the search path.
std::optional<SettingValue> named_file(const Override& given, const SettingSchema& schema) {
  std::error_code ec;
  const std::filesystem::path file(parse_value(given.value).text);
  if (file.empty() || !has_extension(schema, file.string()) || !std::filesystem::is_regular_file(file, ec)) return {};
  return SettingValue{SettingType::file, {1}, std::filesystem::absolute(file, ec).string()};
}

}  // namespace

Result<SettingValue> parse_setting(const Override& given, const SettingSchema& schema, std::string_view where) {
  Value value = parse_value(given.value);
  // A choice may look like something else: `mode=2d`, `mode=true`.
  if (schema.type == SettingType::enumeration && value.kind != Value::Kind::text) {
    value.kind = Value::Kind::text;
    value.text = trim(given.value);
  }
  if (schema.type == SettingType::file) {
    if (where == kCommandLine)
      if (auto file = named_file(given, schema)) return *file;
    value.kind = Value::Kind::text;
    value.text = trim(given.value);
  }
  auto result = check_setting(fmt::format("{}{}.{}", where, given.entry, given.setting), schema, value);
  if (result) return result;
  Error error = result.error();
  error.kind = ErrorKind::usage;
  return error;
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
  if (given.setting == "enabled" || given.setting == "order" || given.setting == "at") {
    AFTERGLOW_TRY(const SettingValue value, parse_setting(given, entry_key_schema(given.setting), kCommandLine));
    if (given.setting == "enabled") entry.enabled = value.number[0] != 0;
    if (given.setting == "order") entry.order = static_cast<int>(value.number[0]);
    if (given.setting == "at") entry.at = value.choice;
    return {};
  }
  std::vector<std::string> names;
  for (const auto& setting : schema.settings) names.push_back(setting.name);
  for (const char* key : {"at", "enabled", "order"}) names.emplace_back(key);
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
