// SPDX-License-Identifier: MIT
// `--set ENTRY.SETTING=VALUE` on a stack that is otherwise complete.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "script/runtime.h"

namespace afterglow::script {

/// Errors (usage): unknown entry or setting (with the nearest), values that the setting does not allow. With
/// `left_out` they are its warnings, and what they are about is left out.
Result<void> apply_overrides(std::vector<DeclaredEntry>& entries, const std::vector<Override>& overrides,
                             Runtime& runtime, Diagnostics* left_out = nullptr);

/// The warning that something from the command line is left out.
void warn_left_out(Diagnostics& diagnostics, Error error);

/// Keys of an entry that --set knows besides settings.
const std::vector<std::string>& settable_keys();
/// What such a key of an entry may be. `mask` is a number here, the same everywhere.
SettingSchema entry_key_schema(const std::string& name);
/// "mask.luma.from" → "mask.luma" and "from"; the first is empty for all that belongs to no part of a mask.
std::pair<std::string, std::string> split_mask_setting(const std::string& name);

/// The value of `ENTRY.SETTING=VALUE`. Errors (usage): what the setting does not allow; `where` stands before the name.
Result<SettingValue> parse_setting(const Override& given, const SettingSchema& schema, std::string_view where);

/// The same for a text; `any_file`: files may be named that lie anywhere.
Result<SettingValue> parse_value_of(const std::string& text, const SettingSchema& schema, const std::string& full_name,
                                    bool any_file = true);

}  // namespace afterglow::script
