// `--set ENTRY.SETTING=VALUE` on a stack that is otherwise complete.
#pragma once

#include <deque>
#include <vector>

#include "script/runtime.h"

namespace afterglow::script {

/// Errors (usage): unknown entry or setting (with the nearest), values that the setting does not allow. With
/// `left_out` they are its warnings, and what they are about is left out.
Result<void> apply_overrides(std::vector<DeclaredEntry>& entries, const std::vector<Override>& overrides,
                             const std::deque<Effect>& effects, Diagnostics* left_out = nullptr);

}  // namespace afterglow::script
