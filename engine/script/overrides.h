// SPDX-License-Identifier: MIT
// `--set ENTRY.SETTING=VALUE` on a stack that is otherwise complete.
#pragma once

#include <string>
#include <vector>

#include "script/runtime.h"

namespace afterglow::script {

/// Errors (usage): unknown entry or setting (with the nearest), values that the setting does not allow. With
/// `left_out` they are its warnings, and what they are about is left out, but for the last `must_fit` ones.
Result<void> apply_overrides(std::vector<DeclaredEntry>& entries, const std::vector<Override>& overrides,
                             Runtime& runtime, Diagnostics* left_out = nullptr, std::size_t must_fit = 0);

/// The warning that something from the command line is left out; once.
void warn_left_out(Diagnostics& diagnostics, Error error);

/// Keys of an entry that --set knows besides settings.
const std::vector<std::string>& settable_keys();

/// What `parse_setting` does, for the text of a value; `any_file`: files may be named that lie anywhere.
Result<SettingValue> parse_value_of(const std::string& text, const SettingSchema& schema, const std::string& full_name,
                                    bool any_file = true);

}  // namespace afterglow::script
