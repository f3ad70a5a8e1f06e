// SPDX-License-Identifier: MIT
// What a run tells whoever started it while it goes on, and asks them.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "core/diagnostics.h"
#include "core/result.h"

namespace afterglow {

/// Functions are called on the thread that runs the frames, `interrupted` between its steps; `diagnostics` takes
/// messages from every thread. All of them outlive the run.
struct RunEvents {
  Diagnostics& diagnostics;
  /// `done` of `total` frames are behind; `label` names the next one; `seconds` since the first began.
  std::function<void(std::size_t done, std::size_t total, const std::string& label, double seconds)> progress;
  std::function<void()> end_progress;
  /// A frame failed and the rest go on.
  std::function<void(const Error&)> failed;
  std::function<void(const std::string&)> note;  ///< of what was found on the way, for whoever wants to know
  /// True: the run ends before its next step, with an error of the kind `interrupted`.
  std::function<bool()> interrupted;
};

}  // namespace afterglow
