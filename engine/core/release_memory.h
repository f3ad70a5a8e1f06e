// SPDX-License-Identifier: MIT
// Giving back what a container holds, before its life ends.
#pragma once

namespace afterglow {

/// Empties a vector or a string and frees its memory. Neither `clear()` nor `= {}` does: both keep the capacity.
template <class Container>
void release_memory(Container& container) {
  Container().swap(container);
}

}  // namespace afterglow
