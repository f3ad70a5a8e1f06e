// SPDX-License-Identifier: MIT
// Values by key, and the order in which they were used.
#pragma once

#include <list>
#include <map>
#include <utility>

namespace afterglow {

/// No call walks all of them: each costs what finding a key costs, however many there are. Not thread-safe.
template <class Key, class Value>
class RecentlyUsed {
 public:
  struct Entry {
    Key key;
    Value value;
  };

  std::size_t size() const { return at_.size(); }
  bool contains(const Key& key) const { return at_.contains(key); }
  /// Null: there is none. It counts as no use.
  const Value* find(const Key& key) const {
    const auto found = at_.find(key);
    return found == at_.end() ? nullptr : &found->second->value;
  }
  /// As the one used last; in place of what the key had.
  void put(const Key& key, Value value) {
    if (touch(key)) {
      entries_.front().value = std::move(value);
      return;
    }
    entries_.push_front({key, std::move(value)});
    at_.emplace(key, entries_.begin());
  }
  /// It is the one used last from now on. False: there is none.
  bool touch(const Key& key) {
    const auto found = at_.find(key);
    if (found == at_.end()) return false;
    entries_.splice(entries_.begin(), entries_, found->second);
    return true;
  }
  void erase(const Key& key) {
    const auto found = at_.find(key);
    if (found == at_.end()) return;
    entries_.erase(found->second);
    at_.erase(found);
  }
  void clear() {
    at_.clear();
    entries_.clear();
  }
  /// All of them, the one used last first.
  const std::list<Entry>& entries() const { return entries_; }

 private:
  std::list<Entry> entries_;
  std::map<Key, typename std::list<Entry>::iterator> at_;
};

}  // namespace afterglow
