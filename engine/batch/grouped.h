// SPDX-License-Identifier: MIT
// Items that have the same name, together.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

namespace afterglow {

/// In the order in which the names, and the items of each, come first. Each item is asked once for its name.
template <class Items, class NameOf>
auto grouped(Items& items, const NameOf& name_of) {
  std::vector<std::vector<typename Items::value_type*>> out;
  std::unordered_map<std::string, std::size_t> places;
  for (auto& item : items) {
    const auto [at, is_new] = places.try_emplace(name_of(item), out.size());
    if (is_new) out.emplace_back();
    out[at->second].push_back(&item);
  }
  return out;
}

}  // namespace afterglow
