// SPDX-License-Identifier: MIT
#include "play/footage_watch.h"

#include <algorithm>
#include <map>
#include <set>

#include "core/exception.h"
#include "core/file.h"
#include "core/file_record.h"
#include "core/stopwatch.h"

namespace afterglow {
namespace {

constexpr double kSweep = 2000;  // ms between two looks at files of which nothing tells
constexpr double kShare = 10;    // looks take at most a tenth of the thread's time

/// A picture and what is read with it, as it was when it was taken.
using Stamps = std::map<std::filesystem::path, Hash>;

/// Those that frames show; numbers of pictures that were rendered anew stay free.
std::set<int> shown_pictures(const Footage& footage) {
  std::set<int> out;
  for (int position = 0; position < footage.frames(); ++position) out.insert(footage.frame(position).picture);
  return out;
}

std::set<std::filesystem::path> folders_of(const Footage& footage) {
  std::set<std::filesystem::path> out;
  for (const int picture : shown_pictures(footage))
    for (const auto& file : footage.files(picture)) out.insert(file.parent_path());
  return out;
}

std::optional<Hash> stamp_now(const std::filesystem::path& file) { return inspect(file, FileProbe::Kind::stamp).seen; }

/// Of pictures that have none. One that is not known is any other than the next.
void take_stamps(const Footage& footage, const auto& stamp, Stamps& taken) {
  for (const int picture : shown_pictures(footage))
    if (const auto [at, is_new] = taken.try_emplace(footage.file(picture)); is_new)
      at->second = stamp_of(footage.files(picture), stamp).value_or(Hash{});
}

/// Files that have changed since they were taken and are whole again.
std::set<std::filesystem::path> changes(const Footage& footage, WholeFiles& whole, Stamps& taken) {
  std::set<std::filesystem::path> out;
  for (const int picture : shown_pictures(footage)) {
    const auto stamp = stamp_of(footage.files(picture), [&](const auto& file) { return whole.whole(file); });
    if (!stamp) continue;
    const auto [known, first] = taken.emplace(footage.file(picture), *stamp);
    if (known->second == *stamp) continue;
    known->second = *stamp;
    out.insert(footage.file(picture));
  }
  return out;
}

}  // namespace

FootageWatch::FootageWatch(FootageOptions options, std::shared_ptr<const Footage> footage,
                           std::function<void()> changed)
    : options_(std::move(options)),
      footage_(std::move(footage)),
      changed_(std::move(changed)),
      whole_(folders_of(*footage_)) {
  if (!footage_->is_video()) thread_ = std::thread([this] { look(); });
}

FootageWatch::~FootageWatch() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  if (thread_.joinable()) thread_.join();
}

std::shared_ptr<const Footage> FootageWatch::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(newer_, nullptr);
}

void FootageWatch::look() {
  Stamps taken;
  take_stamps(
      *footage_, [](const auto& file) { return stamp_now(file); }, taken);
  auto looked = Clock::now();
  double took = 0;
  for (bool due = true;;) {
    {
      const std::lock_guard lock(mutex_);
      if (ends_) return;
    }
    due = whole_.wait() || due;
    const double since = milliseconds_since(looked);
    if (since < took * kShare || (!due && since < kSweep)) continue;
    looked = Clock::now();
    due = false;
    const auto newer = without_exceptions([&] {
      return Footage::anew(options_, *footage_, changes(*footage_, whole_, taken),
                           [&](const std::filesystem::path& file) {
                             return is_file(file) && (taken.contains(file) || whole_.whole(file));
                           });
    });
    took = milliseconds_since(looked);
    if (!newer || !*newer) continue;  // as it was
    footage_ = *newer;
    take_stamps(
        *footage_, [&](const auto& file) { return whole_.whole(file); }, taken);
    {
      const std::lock_guard lock(mutex_);
      newer_ = footage_;
    }
    changed_();
  }
}

}  // namespace afterglow
