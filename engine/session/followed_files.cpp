// SPDX-License-Identifier: MIT
#include "session/followed_files.h"

#include <algorithm>
#include <utility>

namespace afterglow {
namespace {

/// Whether the same paths are to be watched for both.
bool same_paths(const FileProbes& a, const FileProbes& b) {
  return std::ranges::equal(a, b, [](const auto& one, const auto& other) {
    return one.first == other.first &&
           (one.second.kind == FileProbe::Kind::listing) == (other.second.kind == FileProbe::Kind::listing);
  });
}

}  // namespace

FollowedFiles::FollowedFiles(const WatchOptions& options, Watcher::Look look) : trust_stamps_(options.poll) {
  if (look) watcher_ = std::make_unique<Watcher>(options, std::move(look));
}

void FollowedFiles::note_later(FileProbes looks) {
  const std::lock_guard lock(mutex_);
  new_.merge(looks);
}

void FollowedFiles::take_later() {
  {
    const std::lock_guard lock(mutex_);
    if (new_.empty()) return;
    later_.merge(new_);
    new_.clear();
  }
  watch();
}

bool FollowedFiles::follow(FileProbes looks) {
  const bool same = same_paths(build_, looks) && later_.empty();
  build_ = std::move(looks);
  later_.clear();  // frames of the new stack read them again
  if (!same) watch();
  return first_changed(build_).has_value();
}

void FollowedFiles::watch() {
  if (!watcher_) return;
  std::vector<std::filesystem::path> paths = paths_to_watch(build_);
  for (auto& path : paths_to_watch(later_)) paths.push_back(std::move(path));
  watcher_->watch(paths);
}

bool FollowedFiles::build_changed() const { return first_changed(build_, trust_stamps_).has_value(); }
bool FollowedFiles::changed() const { return build_changed() || first_changed(later_); }
std::string FollowedFiles::method() const { return watcher_ ? watcher_->method() : ""; }

}  // namespace afterglow
