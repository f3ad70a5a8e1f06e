// SPDX-License-Identifier: MIT
#include "exec/image_pool.h"

namespace afterglow {

std::shared_ptr<PooledImage> ImagePool::find(const Hash& key) {
  const std::lock_guard lock(mutex_);
  const auto known = images_.find(key);
  return known == images_.end() ? nullptr : known->second.lock();
}

std::shared_ptr<PooledImage> ImagePool::add(const Hash& key, PooledImage made) {
  const std::lock_guard lock(mutex_);
  auto& known = images_[key];
  if (auto quicker = known.lock()) return quicker;
  auto shared = std::make_shared<PooledImage>(std::move(made));
  known = shared;
  ++made_;
  std::erase_if(images_, [](const auto& entry) { return entry.second.expired(); });
  return shared;
}

ImagePool::Counters ImagePool::counters() const {
  const std::lock_guard lock(mutex_);
  Counters counters{.made = made_, .alive = 0, .bytes = 0};
  for (const auto& [key, image] : images_)
    if (const auto alive = image.lock()) {
      ++counters.alive;
      counters.bytes += alive->needs().size;
    }
  return counters;
}

}  // namespace afterglow
