// SPDX-License-Identifier: MIT
// Where warnings and notes go. The library owns no global logger: whoever calls it passes a Diagnostics.
#pragma once

#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <utility>

namespace afterglow {

/// `printed`: a note that a script prints, which its author wants to see.
enum class Severity { note, printed, warning };

/// A sink of messages that do not stop the work. Thread-safe; the sink is called under a lock.
class Diagnostics {
 public:
  using Sink = std::function<void(Severity, const std::string&)>;
  Diagnostics() = default;  ///< drops everything
  explicit Diagnostics(Sink sink) : sink_(std::move(sink)) {}

  void warn(const std::string& message) { emit(Severity::warning, message); }
  void note(const std::string& message) { emit(Severity::note, message); }
  void print(const std::string& message) { emit(Severity::printed, message); }
  /// Warns once per distinct `key` over the life of this object.
  void warn_once(const std::string& key, const std::string& message);
  void note_once(const std::string& key, const std::string& message);  ///< likewise

 private:
  bool is_first(const std::string& key);
  void emit(Severity severity, const std::string& message);
  std::mutex mutex_;
  Sink sink_;
  std::set<std::string> seen_;
};

}  // namespace afterglow
