// SPDX-License-Identifier: MIT
// Settings of the C interface.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/documents.h"
#include "api/handles.h"
#include "core/text.h"

namespace afterglow::api {
namespace {

/// "ENTRY.SETTING" and the text of a value. Errors: usage.
Result<Override> override_of(afterglow_string name, const std::string& value) {
  const std::string full = text_of(name);
  const std::size_t dot = full.find('.');
  const bool has_both = dot != std::string::npos && dot > 0 && dot + 1 < full.size();
  if (!has_both || full.find('=') != std::string::npos)
    return Error{ErrorKind::usage, fmt::format("'{}' is no name of a setting", full), "", 0, "ENTRY.SETTING"};
  return parse_override(full + "=" + value);
}

Result<void> set(afterglow_stack* stack, const char* function, afterglow_string name, const std::string& value) {
  AFTERGLOW_TRY(Backend * backend, backend_of(stack, function));
  AFTERGLOW_TRY(const Override one, override_of(name, value));
  return backend->set({one});
}

Result<std::string> number(double value) {
  if (!std::isfinite(value)) return usage("settings must be finite");
  return fmt::format("{:.17g}", value);
}

/// Errors (usage): unknown entry or setting, with the nearest.
Result<SettingValue> value_of(const afterglow_stack* stack, const char* function, afterglow_string name) {
  AFTERGLOW_TRY(Backend * backend, backend_of(stack, function));
  AFTERGLOW_TRY(const Override parts, override_of(name, "0"));
  const auto& entries = backend->entries();
  std::vector<std::string> names;
  names.reserve(entries.size());
  for (const auto& entry : entries) names.push_back(entry.name);
  const auto entry = std::ranges::find(entries, parts.entry, &StackEntry::name);
  if (entry == entries.end())
    return Error{ErrorKind::usage,
                 fmt::format("the stack has no entry '{}'", parts.entry),
                 "",
                 0,
                 join(names),
                 nearest_name(parts.entry, names)};
  if (auto value = entry_value(*entry, parts.setting)) return *std::move(value);
  names = backend->preset().setting_names(*entry);
  return Error{ErrorKind::usage,
               fmt::format("effect '{}' has no setting '{}'", entry->effect, parts.setting),
               "",
               0,
               join(names),
               nearest_name(parts.setting, names)};
}

Error wrong_type(afterglow_string name, const char* what) {
  return usage(fmt::format("'{}' is no {}", text_of(name), what));
}

}  // namespace
}  // namespace afterglow::api

using namespace afterglow;
using namespace afterglow::api;

afterglow_error* afterglow_stack_settings(const afterglow_stack* stack, afterglow_text** out) {
  return call([&]() -> Result<void> {
    AFTERGLOW_TRY(Backend * backend, backend_of(stack, "afterglow_stack_settings"));
    return give(settings_document(*backend), out, "afterglow_stack_settings");
  });
}

afterglow_error* afterglow_stack_set(afterglow_stack* stack, afterglow_string name, afterglow_string value) {
  return call([&] { return set(stack, "afterglow_stack_set", name, text_of(value)); });
}

afterglow_error* afterglow_stack_set_number(afterglow_stack* stack, afterglow_string name, double value) {
  return call([&]() -> Result<void> {
    AFTERGLOW_TRY(const std::string text, number(value));
    return set(stack, "afterglow_stack_set_number", name, text);
  });
}

afterglow_error* afterglow_stack_set_boolean(afterglow_stack* stack, afterglow_string name, bool value) {
  return call([&] { return set(stack, "afterglow_stack_set_boolean", name, value ? "true" : "false"); });
}

afterglow_error* afterglow_stack_set_text(afterglow_stack* stack, afterglow_string name, afterglow_string value) {
  return call([&] { return set(stack, "afterglow_stack_set_text", name, text_of(value)); });
}

afterglow_error* afterglow_stack_set_numbers(afterglow_stack* stack, afterglow_string name, const double* values,
                                             size_t count) {
  return call([&]() -> Result<void> {
    if (!values || count < 1 || count > 3) return usage("afterglow_stack_set_numbers: 1 to 3 values are possible");
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < count; ++i) {
      AFTERGLOW_TRY(std::string text, number(values[i]));
      texts.push_back(std::move(text));
    }
    return set(stack, "afterglow_stack_set_numbers", name, count == 1 ? texts[0] : "{" + join(texts) + "}");
  });
}

afterglow_error* afterglow_stack_set_several(afterglow_stack* stack, const afterglow_string* names,
                                             const afterglow_string* values, size_t count) {
  return call([&]() -> Result<void> {
    AFTERGLOW_TRY(Backend * backend, backend_of(stack, "afterglow_stack_set_several"));
    if (count > 0 && (!names || !values)) return usage("afterglow_stack_set_several: names or values is NULL");
    std::vector<Override> several;
    for (std::size_t i = 0; i < count; ++i) {
      AFTERGLOW_TRY(several.emplace_back(), override_of(names[i], text_of(values[i])));
    }
    return backend->set(several);
  });
}

afterglow_error* afterglow_stack_unset(afterglow_stack* stack, afterglow_string name) {
  return call([&]() -> Result<void> {
    AFTERGLOW_TRY(Backend * backend, backend_of(stack, "afterglow_stack_unset"));
    if (!is_given(name)) return backend->unset({});
    if (name.size == 0) return usage("afterglow_stack_unset: the name is empty; without one all settings are unset");
    return backend->unset(text_of(name));
  });
}

afterglow_error* afterglow_stack_arguments(const afterglow_stack* stack, afterglow_text** out) {
  return call([&]() -> Result<void> {
    AFTERGLOW_TRY(Backend * backend, backend_of(stack, "afterglow_stack_arguments"));
    return give(arguments_document(*backend), out, "afterglow_stack_arguments");
  });
}

afterglow_error* afterglow_stack_set_argument(afterglow_stack* stack, afterglow_string name, afterglow_string value) {
  return call([&]() -> Result<void> {
    AFTERGLOW_TRY(Backend * backend, backend_of(stack, "afterglow_stack_set_argument"));
    AFTERGLOW_TRY(const ArgumentValue one, parse_argument(text_of(name) + "=" + text_of(value)));
    if (one.name != text_of(name)) return usage(fmt::format("'{}' is no name of an argument", text_of(name)));
    return backend->set_argument(one.name, is_given(value) ? std::optional(one.value) : std::nullopt);
  });
}

afterglow_error* afterglow_stack_get_number(const afterglow_stack* stack, afterglow_string name, double* out) {
  return call([&]() -> Result<void> {
    if (!out) return usage("afterglow_stack_get_number: out is NULL");
    AFTERGLOW_TRY(const SettingValue value, value_of(stack, "afterglow_stack_get_number", name));
    if (number_count(value.type) != 1) return wrong_type(name, "number");
    *out = value.number[0];
    return {};
  });
}

afterglow_error* afterglow_stack_get_boolean(const afterglow_stack* stack, afterglow_string name, bool* out) {
  return call([&]() -> Result<void> {
    if (!out) return usage("afterglow_stack_get_boolean: out is NULL");
    AFTERGLOW_TRY(const SettingValue value, value_of(stack, "afterglow_stack_get_boolean", name));
    if (value.type != SettingType::boolean) return wrong_type(name, "boolean");
    *out = value.number[0] != 0;
    return {};
  });
}

afterglow_error* afterglow_stack_get_text(const afterglow_stack* stack, afterglow_string name, afterglow_text** out) {
  return call([&]() -> Result<void> {
    AFTERGLOW_TRY(const SettingValue value, value_of(stack, "afterglow_stack_get_text", name));
    if (value.type != SettingType::enumeration && value.type != SettingType::file && value.type != SettingType::text)
      return wrong_type(name, "choice, file or text");
    return give(value.choice, out, "afterglow_stack_get_text");
  });
}

afterglow_error* afterglow_stack_get_numbers(const afterglow_stack* stack, afterglow_string name, double* values,
                                             size_t capacity, size_t* count) {
  return call([&]() -> Result<void> {
    if (!count || (!values && capacity > 0)) return usage("afterglow_stack_get_numbers: values or count is NULL");
    AFTERGLOW_TRY(const SettingValue value, value_of(stack, "afterglow_stack_get_numbers", name));
    *count = number_count(value.type);
    if (*count == 0) return wrong_type(name, "number, vector or colour");
    std::copy_n(value.number.begin(), std::min(capacity, *count), values);
    return {};
  });
}
