// SPDX-License-Identifier: MIT
// How long this process waits for bytes of its inputs, and that nobody waits for them any more.
#pragma once

#include <atomic>
#include <chrono>
#include <optional>
#include <string>

#include "core/result.h"

namespace afterglow {

/// Of one reader. `given_up` may be set by anyone, at any time; it outlives the reader.
struct Patience {
  /// Without a byte; 0: for ever. Nothing said: five minutes for files, which are there or on a network that is gone;
  /// for ever for pipes, whose writer may need hours for a frame.
  std::optional<std::chrono::milliseconds> most = {};
  const std::atomic<bool>* given_up = nullptr;
};

/// "90", "0.5": seconds; empty: the usual ones. Errors: usage, naming AFTERGLOW_INPUT_TIMEOUT.
Result<Patience> parse_patience(const std::string& seconds);

/// What AFTERGLOW_INPUT_TIMEOUT says, and `give_up_waiting`. Errors: usage.
Result<Patience> patience_of_process();

/// All that waits for bytes of inputs ends soon, for ever. For signal handlers: takes no lock and no memory.
void give_up_waiting() noexcept;

}  // namespace afterglow
