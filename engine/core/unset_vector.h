// SPDX-License-Identifier: MIT
// A vector for numbers that are written before they are read: pixels that are decoded or downloaded into it.
#pragma once

#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace afterglow {

/// Leaves new values as the memory is. To set them to zero first is a pass over the memory that one thread makes alone.
template <class Value>
struct UnsetAllocator : std::allocator<Value> {
  template <class Other>
  struct rebind {
    using other = UnsetAllocator<Other>;
  };
  template <class Other, class... Arguments>
  void construct(Other* at, Arguments&&... arguments) {
    if constexpr (sizeof...(Arguments) == 0)
      ::new (static_cast<void*>(at)) Other;
    else
      std::construct_at(at, std::forward<Arguments>(arguments)...);
  }
};

/// A vector of numbers whose `resize` leaves new ones unset.
template <class Value>
using UnsetVector = std::vector<Value, UnsetAllocator<Value>>;

}  // namespace afterglow
