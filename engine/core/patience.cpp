// SPDX-License-Identifier: MIT
#include "core/patience.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "core/parse_number.h"

namespace afterglow {
namespace {

/// Signal handlers reach nothing else.
std::atomic<bool> g_given_up{false};
static_assert(std::atomic<bool>::is_always_lock_free);

constexpr double kLongest = 1e6;  // seconds: 11 days

}  // namespace

Result<Patience> parse_patience(const std::string& seconds) {
  Patience out;
  if (seconds.empty()) return out;
  const auto number = parse_number<double>(seconds);
  if (!number || !(*number >= 0) || *number > kLongest)
    return Error{ErrorKind::usage, fmt::format("'{}' is no number of seconds", seconds), "AFTERGLOW_INPUT_TIMEOUT", 0,
                 "0 (for ever) to 1000000"};
  const std::chrono::milliseconds most(static_cast<long long>(*number * 1000));
  // Less than a unit is still a limit.
  out.most = *number > 0 ? std::max(most, std::chrono::milliseconds(1)) : most;
  return out;
}

Result<Patience> patience_of_process() {
  const char* seconds = std::getenv("AFTERGLOW_INPUT_TIMEOUT");
  AFTERGLOW_TRY(Patience out, parse_patience(seconds ? seconds : ""));
  out.given_up = &g_given_up;
  return out;
}

void give_up_waiting() noexcept { g_given_up = true; }

}  // namespace afterglow
