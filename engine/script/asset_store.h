// SPDX-License-Identifier: MIT
// What was made of tables, pictures and configurations, for the next look that reads the same.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "core/hash.h"

namespace afterglow {

/// A look is one state of scripts. What neither the newest look nor the two before it have used goes. Thread-safe.
class AssetStore {
 public:
  /// The number of a new look.
  std::uint64_t begin_look();

  /// What `make` gave before for the key, which says everything that decides the result, its type too. `make` runs
  /// without a lock, and what it throws comes out.
  template <class T, class Make>
  std::shared_ptr<const T> get(const Hash& key, std::uint64_t look, const Make& make) {
    if (auto known = find(key, look)) return std::static_pointer_cast<const T>(std::move(known));
    std::shared_ptr<const T> made = make();
    add(key, look, made);
    return made;
  }

  /// Forgets what was made for that key.
  void drop(const Hash& key);

  std::uint64_t made() const;  ///< so far
  std::size_t kept() const;    ///< now

 private:
  struct Entry {
    std::shared_ptr<const void> value;
    std::uint64_t look = 0;  ///< the newest one that used it
  };
  std::shared_ptr<const void> find(const Hash& key, std::uint64_t look);
  void add(const Hash& key, std::uint64_t look, std::shared_ptr<const void> value);

  mutable std::mutex mutex_;
  std::map<Hash, Entry> entries_;
  std::uint64_t looks_ = 0, made_ = 0;
};

}  // namespace afterglow
