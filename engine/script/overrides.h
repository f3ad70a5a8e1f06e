// `--set ENTRY.SETTING=VALUE` on a stack that is otherwise complete.
#pragma once

#include <deque>
#include <vector>

#include "script/runtime.h"

namespace afterglow::script {

/// Errors (usage): unknown entry or setting (with the nearest), values that the setting does not allow.
Result<void> apply_overrides(std::vector<DeclaredEntry>& entries, const std::vector<Override>& overrides,
                             const std::deque<Effect>& effects);

}  // namespace afterglow::script
