// SPDX-License-Identifier: MIT
// Loops over threads. No pool, no global state: a thread's start costs some 20 µs, what is worth one takes ms.
#pragma once

#include <cstddef>
#include <functional>

namespace afterglow {

/// Calls work(i) for every i below `count`, each once, on up to as many threads as the machine has; the caller's is one
/// of them. An exception ends the loop as soon as what has begun is done; the first one is rethrown.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace afterglow
