// SPDX-License-Identifier: MIT
// A run's events on the console.
#pragma once

#include "apps/console.h"
#include "apps/interrupt.h"
#include "batch/batch_run.h"

namespace afterglow {

inline RunEvents run_events(Console& console) {
  return {.diagnostics = console.diagnostics(),
          .progress = [&console](std::size_t done, std::size_t total, const std::string& label,
                                 double seconds) { console.progress(done, total, label, seconds); },
          .end_progress = [&console] { console.end_progress(); },
          .failed = [&console](const Error& error) { console.error(error); },
          .note = [&console](const std::string& text) { console.note(text); },
          .interrupted = interrupted};
}

}  // namespace afterglow
