// SPDX-License-Identifier: MIT
// Work beside that of the caller.
#pragma once

#include <future>
#include <memory>
#include <system_error>
#include <utility>

namespace afterglow {

/// Begins `work` on another thread. Where no more threads can be had it is done by whoever asks for its result, and not
/// at all where nobody does.
template <typename Work>
auto beside(Work work) -> std::future<decltype(work())> {
  const auto kept = std::make_shared<Work>(std::move(work));  // std::async takes what it is given, and then fails
  const auto run = [kept] { return (*kept)(); };
  try {
    return std::async(std::launch::async, run);
  } catch (const std::system_error&) {
    return std::async(std::launch::deferred, run);
  }
}

}  // namespace afterglow
