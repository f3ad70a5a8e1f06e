// SPDX-License-Identifier: MIT
#include "script/asset_store.h"

#include <algorithm>

namespace afterglow {
namespace {

constexpr std::uint64_t kKept = 2;  // looks before the newest: the one that it follows, and one to go back to

}  // namespace

std::uint64_t AssetStore::begin_look() {
  const std::lock_guard lock(mutex_);
  ++looks_;
  std::erase_if(entries_, [this](const auto& entry) { return entry.second.look + kKept < looks_; });
  return looks_;
}

std::shared_ptr<const void> AssetStore::find(const Hash& key, std::uint64_t look) {
  const std::lock_guard lock(mutex_);
  const auto known = entries_.find(key);
  if (known == entries_.end()) return nullptr;
  known->second.look = std::max(known->second.look, look);
  return known->second.value;
}

void AssetStore::add(const Hash& key, std::uint64_t look, std::shared_ptr<const void> value) {
  const std::lock_guard lock(mutex_);
  ++made_;
  entries_.insert_or_assign(key, Entry{std::move(value), look});
}

void AssetStore::drop(const Hash& key) {
  const std::lock_guard lock(mutex_);
  entries_.erase(key);
}

std::uint64_t AssetStore::made() const {
  const std::lock_guard lock(mutex_);
  return made_;
}

std::size_t AssetStore::kept() const {
  const std::lock_guard lock(mutex_);
  return entries_.size();
}

}  // namespace afterglow
