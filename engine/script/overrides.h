// `--set ENTRY.SETTING=VALUE` on a stack that is otherwise complete.
#pragma once

#include <deque>
#include <string_view>
#include <vector>

#include "script/runtime.h"

namespace afterglow::script {

/// Errors (usage): unknown entry or setting (with the nearest), values that the setting does not allow. With
/// `left_out` they are its warnings, and what they are about is left out.
Result<void> apply_overrides(std::vector<DeclaredEntry>& entries, const std::vector<Override>& overrides,
                             const std::deque<Effect>& effects, Diagnostics* left_out = nullptr);

/// What `enabled`, `order`, `at`, `opacity` and `blend` of an entry may be.
SettingSchema entry_key_schema(const std::string& name);

/// The value of `ENTRY.SETTING=VALUE`. Errors (usage): what the setting does not allow; `where` stands before the name.
Result<SettingValue> parse_setting(const Override& given, const SettingSchema& schema, std::string_view where);

/// The same for a text; `any_file`: files may be named that lie anywhere.
Result<SettingValue> parse_value_of(const std::string& text, const SettingSchema& schema, const std::string& full_name,
                                    bool any_file = true);

}  // namespace afterglow::script
