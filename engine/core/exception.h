// SPDX-License-Identifier: MIT
// What exceptions become where they leave code that throws: see result.h.
#pragma once

#include <exception>
#include <string>

#include "core/result.h"

namespace afterglow {

/// The message where a limit on threads is met.
inline constexpr const char* kNoMoreThreads =
    "no more threads can be started (ulimit -u or -v, or pids of the control group)";

/// What the exception of a library says, as house messages are: one line without a full stop; "out of memory" for
/// std::bad_alloc.
std::string exception_text(const std::exception& exception);

/// An exception that nobody expects: io for the lack of memory, else other ("internal error: …").
Error exception_error(const std::exception& exception);

/// The Result that `work` gives; what it throws is its error. For threads, where an exception would end the program.
template <typename Work>
auto without_exceptions(Work&& work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::exception& exception) {
    return exception_error(exception);
  }
}

}  // namespace afterglow
