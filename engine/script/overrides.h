// `--set ENTRY.SETTING=VALUE` on a stack that is otherwise complete.
#pragma once

#include <deque>
#include <string_view>
#include <vector>

#include "script/runtime.h"

namespace afterglow::script {

/// Errors (usage): unknown entry or setting (with the nearest), values that the setting does not allow.
Result<void> apply_overrides(std::vector<DeclaredEntry>& entries, const std::vector<Override>& overrides,
                             const std::deque<Effect>& effects);

/// What `enabled`, `order` and `at` of an entry may be.
SettingSchema entry_key_schema(const std::string& name);

/// The value of `ENTRY.SETTING=VALUE`. Errors (usage): what the setting does not allow; `where` stands before the name.
Result<SettingValue> parse_setting(const Override& given, const SettingSchema& schema, std::string_view where);

}  // namespace afterglow::script
