// SPDX-License-Identifier: MIT
#include "script/overrides.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/near_path.h"
#include "core/text.h"
#include "script/injection.h"
#include "script/mask.h"
#include "script/setting.h"

namespace afterglow {

Result<Override> parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t dot = text.find('.');
  if (equals == std::string::npos || dot >= equals || dot == 0 || dot + 1 == equals)
    return Error{ErrorKind::usage, fmt::format("--set '{}' is no override", tidy_message(text, 100)), "", 0,
                 "ENTRY.SETTING=VALUE"};
  return Override{trim(text.substr(0, dot)), trim(text.substr(dot + 1, equals - dot - 1)), text.substr(equals + 1)};
}

namespace script {
namespace {

std::string doc_of_key(const std::string& name) {
  if (name == "opacity") return "How much of the result counts; at 0 the effect does not run.";
  if (name == "blend") return "How the result is put over what the effect was given.";
  if (name == "mask") return "Where the result counts.";
  return "";
}

}  // namespace

SettingSchema entry_key_schema(const std::string& name) {
  SettingSchema schema;
  schema.name = name;
  if (name == "enabled") schema.type = SettingType::boolean;
  if (name == "order") {
    schema.type = SettingType::integer;
    schema.min = -1e6;
    schema.max = 1e6;
  }
  if (name == "opacity" || name == "mask") {
    schema.min = 0;
    schema.max = 1;
    schema.default_value.number[0] = 1;
  }
  if (name == "blend") {
    schema.type = SettingType::enumeration;
    schema.choices = blend_modes();
    schema.default_value.choice = schema.choices.front();
  }
  if (name == "at") {
    schema.type = SettingType::enumeration;
    schema.choices = injection_points();
  }
  schema.doc = doc_of_key(name);
  schema.default_value.type = schema.type;
  return schema;
}

const std::vector<std::string>& settable_keys() {
  static const std::vector<std::string> keys{"at", "blend", "enabled", "mask", "opacity", "order"};
  return keys;
}

std::pair<std::string, std::string> split_mask_setting(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  if (!name.starts_with("mask.") || dot < 5) return {"", name};
  return {name.substr(0, dot), name.substr(dot + 1)};
}

std::string missing_mask(const std::string& setting, const std::vector<std::string>& names) {
  const std::string part = split_mask_setting(setting).first;
  const auto is_of_part = [&](const std::string& name) { return split_mask_setting(name).first == part; };
  return part.empty() || std::ranges::any_of(names, is_of_part) ? "" : part.substr(std::string_view("mask.").size());
}

namespace {

constexpr std::string_view kCommandLine = "--set ";

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
    if (text.find('\0') != std::string::npos)
      return Error{ErrorKind::usage,
                   fmt::format("{} = {}: embedded NUL in the name of a file", full_name, value.shown())};
    if (any_file)
      if (auto file = named_file(text, schema)) return *file;
    value.text = value.kind == Value::Kind::text ? value.text : trim(text);
    value.kind = Value::Kind::text;
    if (any_file && !value.text.empty() && !is_tidy_path(value.text)) {
      const std::filesystem::path file(value.text);
      std::error_code ec;
      if (!std::filesystem::is_regular_file(file, ec))
        return Error{ErrorKind::usage, fmt::format("{} = {}: there is no such file", full_name, value.shown())};
      value.text = file.filename().string();  // it is its kind that is wrong
    }
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

// A setting of the entry's effect, or of the mask's script that stands for it. False: there is none of this name.
Result<bool> apply_setting(DeclaredEntry& declared, const Override& given, const std::string& name,
                           const EffectSchema& schema) {
  const auto found = std::ranges::find(schema.settings, name, &SettingSchema::name);
  if (found == schema.settings.end()) return false;
  AFTERGLOW_TRY(SettingValue value, parse_setting(given, *found, kCommandLine));
  declared.sources[static_cast<std::size_t>(found - schema.settings.begin())].overridden = std::move(value);
  return true;
}

Result<void> apply(DeclaredEntry& declared, const Override& given, Runtime& runtime) {
  const auto schema_of = [&](const DeclaredEntry& of) -> const EffectSchema& {
    return runtime.effects[static_cast<std::size_t>(of.effect)].schema;
  };
  const EffectSchema& schema = schema_of(declared);
  StackEntry& entry = declared.entry;
  AFTERGLOW_TRY(const bool done, apply_setting(declared, given, given.setting, schema));
  if (done) return {};
  const int of_preset = declared.preset_mask.value_or(declared.mask);
  if (const auto [part, name] = split_mask_setting(given.setting); !part.empty())
    if (DeclaredEntry* own = own_mask_part(runtime, declared.mask, part)) {
      AFTERGLOW_TRY(const bool of_part, apply_setting(*own, given, name, schema_of(*own)));
      if (of_part) return {};
    }
  if (std::ranges::find(settable_keys(), given.setting) != settable_keys().end()) {
    AFTERGLOW_TRY(const SettingValue value, parse_setting(given, entry_key_schema(given.setting), kCommandLine));
    if (given.setting == "enabled") entry.enabled = value.number[0] != 0;
    if (given.setting == "order") entry.order = static_cast<int>(value.number[0]);
    if (given.setting == "at") entry.at = value.choice;
    declared.says_order = declared.says_order || given.setting == "order";
    declared.says_at = declared.says_at || given.setting == "at";
    if (given.setting == "blend") declared.blend.overridden = value;
    if (given.setting == "opacity") declared.opacity.overridden = value;
    if (given.setting == "mask") {
      declared.preset_mask = of_preset;
      declared.mask = make_number_mask(runtime, value.number[0]);
    }
    return {};
  }
  std::vector<std::string> names;
  for (const auto& setting : schema.settings) names.push_back(setting.name);
  names.insert(names.end(), settable_keys().begin(), settable_keys().end());
  for (auto& name : mask_setting_names(runtime, declared.mask)) names.push_back(std::move(name));
  const std::string mask = missing_mask(given.setting, names);
  return Error{ErrorKind::usage,
               fmt::format("--set {}.{}: {}", given.entry, given.setting,
                           mask.empty() ? fmt::format("effect '{}' has no such setting", schema.name)
                                        : fmt::format("the entry has no mask '{}'", mask)),
               "",
               0,
               join(names),
               nearest_name(given.setting, names)};
}

Result<void> apply_everywhere(std::vector<DeclaredEntry>& entries, const Override& given, Runtime& runtime) {
  const auto named = [&](const DeclaredEntry& e) { return e.entry.name == given.entry; };
  const bool by_name = std::any_of(entries.begin(), entries.end(), named);
  bool found = false;
  std::vector<std::string> names;
  for (auto& declared : entries) {
    names.push_back(declared.entry.name);
    if (by_name ? !named(declared) : declared.entry.effect != given.entry) continue;
    found = true;
    AFTERGLOW_CHECK(apply(declared, given, runtime));
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

void warn_left_out(Diagnostics& diagnostics, Error error) {
  error.message += "; it is left out";
  std::string text = error.text();
  if (text.starts_with("error: ")) text.erase(0, 7);
  diagnostics.warn_once(text, text);
}

Result<void> apply_overrides(std::vector<DeclaredEntry>& entries, const std::vector<Override>& overrides,
                             Runtime& runtime, Diagnostics* left_out, std::size_t must_fit) {
  for (std::size_t i = 0; i < overrides.size(); ++i) {
    auto applied = apply_everywhere(entries, overrides[i], runtime);
    if (applied) continue;
    if (!left_out || overrides.size() - i <= must_fit) return applied;
    warn_left_out(*left_out, std::move(applied).error());
  }
  return {};
}

}  // namespace script
}  // namespace afterglow
