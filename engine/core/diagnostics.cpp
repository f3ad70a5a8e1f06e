// SPDX-License-Identifier: MIT
#include "core/diagnostics.h"

#include "core/printable.h"

namespace afterglow {

void Diagnostics::warn_once(const std::string& key, const std::string& message) {
  {
    std::lock_guard lock(mutex_);
    if (!seen_.insert(key).second) return;
  }
  warn(message);
}

void Diagnostics::emit(Severity severity, const std::string& message) {
  std::lock_guard lock(mutex_);
  if (sink_) sink_(severity, printable(message, true));
}

}  // namespace afterglow
