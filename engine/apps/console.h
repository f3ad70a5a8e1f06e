// SPDX-License-Identifier: MIT
// What the user sees on stderr: errors, warnings, progress. One per process; thread-safe.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>

#include "core/diagnostics.h"
#include "core/result.h"

namespace spdlog {
class logger;
}

namespace afterglow {

enum class Verbosity { quiet, normal, verbose };

class Console {
 public:
  Console();
  ~Console();

  /// `color` may only forbid colours; they also need a terminal that has them, and NO_COLOR unset.
  void configure(Verbosity verbosity, bool color);
  Verbosity verbosity() const { return verbosity_; }

  /// `FILE:LINE: error: …` and its trail.
  void error(const Error& error);
  void warning(const std::string& text);
  std::size_t warnings() const { return warnings_; }  ///< that there were, also where nobody sees them
  void note(const std::string& text);                 ///< shown with -v
  void show_prints() { prints_shown_ = true; }        ///< what scripts print is shown without -v
  /// Warnings and notes of the engine end here.
  Diagnostics& diagnostics() { return diagnostics_; }

  /// Shows `done` of `total` with a label on one line that overwrites itself; nothing unless stderr is a terminal.
  void progress(std::size_t done, std::size_t total, const std::string& label, double seconds);
  void end_progress();

 private:
  void remark(const std::string& text);
  void erase_progress();  // with mutex_ held
  std::mutex mutex_;
  std::atomic<std::size_t> warnings_ = 0;
  std::shared_ptr<spdlog::logger> log_;
  Diagnostics diagnostics_;
  Verbosity verbosity_ = Verbosity::normal;
  bool prints_shown_ = false;
  bool terminal_ = false, color_ = false, progress_shown_ = false;
};

}  // namespace afterglow
