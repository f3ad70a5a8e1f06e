// Loops over threads.
#pragma once

#include <cstddef>
#include <functional>

namespace afterglow {

/// Calls work(i) for every i below `count`, each once, on up to as many threads as the machine has; the caller's is one
/// of them.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace afterglow
