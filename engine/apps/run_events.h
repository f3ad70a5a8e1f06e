// SPDX-License-Identifier: MIT
// A run's events on the console.
#pragma once

#include <memory>

#include "apps/console.h"
#include "apps/interrupt.h"
#include "apps/missing_frames.h"
#include "batch/batch_run.h"

namespace afterglow {

inline RunEvents run_events(Console& console) {
  const auto missing = std::make_shared<MissingFrames>([&console](const Error& error) { console.error(error); });
  return {.diagnostics = console.diagnostics(),
          .progress =
              [&console, missing](std::size_t done, std::size_t total, const std::string& label, double seconds) {
                missing->next();
                console.progress(done, total, label, seconds);
              },
          .end_progress = [&console] { console.end_progress(); },
          .failed = [missing](const Error& error) { missing->add(error); },
          .note = [&console](const std::string& text) { console.note(text); },
          .interrupted = interrupted};
}

}  // namespace afterglow
