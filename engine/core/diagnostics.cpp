// SPDX-License-Identifier: MIT
#include "core/diagnostics.h"

#include "core/printable.h"

namespace afterglow {

void Diagnostics::warn_once(const std::string& key, const std::string& message) {
  if (is_first(key)) warn(message);
}

void Diagnostics::note_once(const std::string& key, const std::string& message) {
  if (is_first(key)) note(message);
}

bool Diagnostics::is_first(const std::string& key) {
  std::lock_guard lock(mutex_);
  return seen_.insert(key).second;
}

void Diagnostics::emit(Severity severity, const std::string& message) {
  std::lock_guard lock(mutex_);
  if (sink_) sink_(severity, printable(message, true));
}

}  // namespace afterglow
