// SPDX-License-Identifier: MIT
#include "play/read_ahead.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "core/stopwatch.h"
#include "play/packed_picture.h"
#include "play/recently_used.h"

namespace afterglow {
/// A picture as it is kept.
struct KeptPicture {
  int key = 0;
  /// Of what is not smaller when it is packed, and of errors.
  std::shared_ptr<const ReadPicture> whole;
  PackedPicture packed;
  double milliseconds = 0;  ///< that reading took
  std::uint64_t bytes = 0, pixels = 0;
  bool failed = false;
  mutable std::weak_ptr<const ReadPicture> opened;  ///< with State::mutex held
};

/// Memory of pictures that nobody looks at any more: new memory costs more than a picture's way into it.
struct SpareMemory {
  std::mutex mutex;
  std::vector<float> pixels;
};

struct ReadAhead::State {
  Read read;
  ReadAheadOptions options;
  std::function<void()> arrived;

  mutable std::mutex mutex;
  std::condition_variable work, done;
  std::vector<int> wanted;
  RecentlyUsed<int, std::shared_ptr<const KeptPicture>> pictures;
  std::set<int> failed;  ///< keys of those among them that are errors
  std::set<int> reading;
  std::uint64_t bytes = 0, pixels = 0, expected = 0;  ///< of the pictures; bytes of one that has yet to be read
  std::uint64_t epoch = 0;                            ///< grows when everything is thrown away
  Stats stats;
  double total_milliseconds = 0;
  bool ending = false;
  std::vector<std::thread> threads;
  std::shared_ptr<SpareMemory> spare = std::make_shared<SpareMemory>();

  /// Without `mutex`.
  std::shared_ptr<const ReadPicture> open(const std::shared_ptr<const KeptPicture>& kept);

  // All of these with `mutex` held.
  std::optional<int> next() const;
  bool is_wanted(int key) const { return std::ranges::find(wanted, key) != wanted.end(); }
  std::size_t rank(int key) const { return static_cast<std::size_t>(std::ranges::find(wanted, key) - wanted.begin()); }
  bool make_room(std::uint64_t more, std::size_t before);
  void drop(int key);
  void take(std::shared_ptr<const KeptPicture> picture);
  void read_next(std::unique_lock<std::mutex>& lock, int key);
  void run();
};

/// The most urgent picture that nobody has read or reads.
std::optional<int> ReadAhead::State::next() const {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const int key = wanted[i];
    if (const auto* found = pictures.find(key)) {
      sum += (*found)->bytes;
      continue;
    }
    sum += expected;
    if (i > 0 && sum > options.max_bytes) return std::nullopt;  // what lies further ahead has no room
    if (!reading.contains(key)) return key;
    // Until the first has come, nobody knows how large they are: one at a time.
    if (expected == 0) return std::nullopt;
  }
  return std::nullopt;
}

void ReadAhead::State::drop(int key) {
  const KeptPicture& gone = **pictures.find(key);
  bytes -= gone.bytes;
  pixels -= gone.pixels;
  failed.erase(key);
  pictures.erase(key);
}

/// Room for so many bytes, at the cost of what nobody wants, then of what is wanted later than `before`.
bool ReadAhead::State::make_room(std::uint64_t more, std::size_t before) {
  const auto fits = [&] { return bytes + more <= options.max_bytes; };
  while (!fits()) {
    const auto& kept = pictures.entries();
    const auto unwanted =
        std::find_if(kept.rbegin(), kept.rend(), [&](const auto& one) { return !is_wanted(one.key); });
    std::optional<int> victim;
    if (unwanted != kept.rend()) victim = unwanted->key;
    for (std::size_t i = wanted.size(); !victim && i > before + 1; --i)
      if (pictures.contains(wanted[i - 1])) victim = wanted[i - 1];
    if (!victim) return false;
    drop(*victim);
    ++stats.evicted;
  }
  return true;
}

namespace {

std::shared_ptr<const KeptPicture> kept_picture(int key, Result<Picture> result, double milliseconds) {
  auto out = std::make_shared<KeptPicture>();
  out->key = key;
  out->milliseconds = milliseconds;
  auto whole = std::make_shared<ReadPicture>();
  whole->key = key;
  whole->milliseconds = milliseconds;
  if (result) {
    out->pixels = static_cast<std::uint64_t>(result->color.size().area());
    PackedPicture packed(std::move(result).value());
    out->bytes = packed.bytes();
    if (packed.smaller()) {
      out->packed = std::move(packed);
      return out;
    }
    whole->picture = std::move(packed).whole();
  } else {
    out->failed = true;
    whole->error = std::move(result).error();
  }
  out->whole = std::move(whole);
  return out;
}

}  // namespace

std::shared_ptr<const ReadPicture> ReadAhead::State::open(const std::shared_ptr<const KeptPicture>& kept) {
  if (kept->whole) return kept->whole;
  {
    const std::lock_guard lock(mutex);
    if (auto opened = kept->opened.lock()) return opened;
  }
  std::vector<float> memory;
  {
    const std::lock_guard lock(spare->mutex);
    memory.swap(spare->pixels);
  }
  const auto give_back = [to = spare](ReadPicture* gone) {
    {
      const std::lock_guard lock(to->mutex);
      to->pixels.swap(gone->picture.color.pixels);
    }
    delete gone;
  };
  std::shared_ptr<ReadPicture> made(new ReadPicture, give_back);
  made->key = kept->key;
  made->milliseconds = kept->milliseconds;
  made->picture = kept->packed.open(std::move(memory));
  const std::lock_guard lock(mutex);
  if (auto opened = kept->opened.lock()) return opened;
  kept->opened = made;
  return made;
}

void ReadAhead::State::take(std::shared_ptr<const KeptPicture> picture) {
  const int key = picture->key;
  ++stats.read;
  if (picture->failed) ++stats.failed;
  total_milliseconds += picture->milliseconds;
  expected = std::max(expected, picture->bytes);
  // Nobody waits for it any more: kept where that costs nothing.
  if (!is_wanted(key) && (picture->failed || bytes + picture->bytes > options.max_bytes)) return;
  if (!make_room(picture->bytes, rank(key)) && rank(key) > 0) return;
  bytes += picture->bytes;
  pixels += picture->pixels;
  stats.most_bytes = std::max(stats.most_bytes, bytes);
  if (picture->failed) failed.insert(key);
  pictures.put(key, std::move(picture));
}

void ReadAhead::State::run() {
  std::unique_lock lock(mutex);
  while (true) {
    std::optional<int> key;
    work.wait(lock, [&] { return ending || (key = next()); });
    if (ending) return;
    try {
      read_next(lock, *key);
    } catch (const std::exception&) {  // out of memory: it is still wanted, and tried again when others have had a turn
      constexpr std::chrono::milliseconds kPause{20};
      if (!lock.owns_lock()) lock.lock();
      reading.erase(*key);
      work.wait_for(lock, kPause, [&] { return ending; });
    }
  }
}

void ReadAhead::State::read_next(std::unique_lock<std::mutex>& lock, int key) {
  reading.insert(key);
  const std::uint64_t began_in = epoch;
  // Before it is read, so that the bound holds while both exist.
  make_room(expected * reading.size(), rank(key));
  lock.unlock();
  const auto start = Clock::now();
  auto result = read(key);
  auto made = kept_picture(key, std::move(result), milliseconds_since(start));
  lock.lock();
  if (began_in == epoch) {
    reading.erase(key);
    take(std::move(made));
  }
  lock.unlock();
  done.notify_all();
  work.notify_all();
  if (arrived) arrived();
  lock.lock();
}

ReadAhead::ReadAhead(Read read, const ReadAheadOptions& options, std::function<void()> arrived)
    : state_(std::make_unique<State>()) {
  state_->read = std::move(read);
  state_->options = options;
  state_->arrived = std::move(arrived);
  try {
    for (int i = 0; i < std::max(options.threads, 1); ++i) state_->threads.emplace_back([this] { state_->run(); });
  } catch (const std::exception&) {  // no more threads to be had: those that run read
    if (state_->threads.empty()) throw;
  }
}

ReadAhead::~ReadAhead() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->ending = true;
  }
  state_->work.notify_all();
  for (auto& thread : state_->threads) thread.join();
}

void ReadAhead::want(const std::vector<int>& keys) {
  {
    const std::lock_guard lock(state_->mutex);
    State& s = *state_;
    if (keys == s.wanted) return;
    s.wanted = keys;
    // Errors that nobody looks at: the file may be better when it is wanted again.
    for (auto at = s.failed.begin(); at != s.failed.end();) {
      const int key = *at++;
      if (!s.is_wanted(key)) s.drop(key);
    }
    for (auto key = keys.rbegin(); key != keys.rend(); ++key) s.pictures.touch(*key);
  }
  state_->work.notify_all();
}

std::shared_ptr<const ReadPicture> ReadAhead::find(int key) const {
  std::shared_ptr<const KeptPicture> kept;
  {
    const std::lock_guard lock(state_->mutex);
    const auto* found = state_->pictures.find(key);
    if (!found) return nullptr;
    kept = *found;
  }
  return state_->open(kept);
}

bool ReadAhead::has(int key) const {
  const std::lock_guard lock(state_->mutex);
  return state_->pictures.contains(key);
}

std::shared_ptr<const ReadPicture> ReadAhead::wait(int key) {
  State& s = *state_;
  std::shared_ptr<const KeptPicture> kept;
  {
    std::unique_lock lock(s.mutex);
    if (!s.pictures.contains(key)) {
      std::erase(s.wanted, key);
      s.wanted.insert(s.wanted.begin(), key);
      s.work.notify_all();
      s.done.wait(lock, [&] { return s.pictures.contains(key); });
    }
    kept = *s.pictures.find(key);
  }
  return s.open(kept);
}

void ReadAhead::forget() {
  {
    const std::lock_guard lock(state_->mutex);
    State& s = *state_;
    ++s.epoch;
    s.reading.clear();
    s.pictures.clear();
    s.failed.clear();
    s.bytes = s.pixels = s.expected = 0;
  }
  state_->work.notify_all();
}

ReadAhead::Stats ReadAhead::stats() const {
  const std::lock_guard lock(state_->mutex);
  Stats stats = state_->stats;
  stats.bytes = state_->bytes;
  stats.max_bytes = state_->options.max_bytes;
  stats.pictures = static_cast<int>(state_->pictures.size());
  stats.pixels = state_->pixels;
  for (const int key : state_->wanted) {
    if (!state_->pictures.contains(key)) break;
    ++stats.ahead;
  }
  if (stats.read > 0) stats.milliseconds = state_->total_milliseconds / static_cast<double>(stats.read);
  return stats;
}

}  // namespace afterglow
