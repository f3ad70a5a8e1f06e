// SPDX-License-Identifier: MIT
// The cache of pictures: bounded, in order, cancelled, with errors. Reading is held up and let go by the tests.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <map>
#include <mutex>

#include "play/read_ahead.h"

namespace afterglow {
namespace {

using ::testing::ElementsAre;

constexpr std::uint64_t kPictureBytes = 10 * 10 * 4 * sizeof(float);

/// Reads pictures of 10×10 whose values are their keys; negative keys fail. With `hold`, each waits for `let`.
class Reader {
 public:
  explicit Reader(bool hold = false) : allowed_(hold ? 0 : 1 << 30) {}

  Result<Picture> operator()(int key) {
    std::unique_lock lock(mutex_);
    order_.push_back(key);
    began_.notify_all();
    go_.wait(lock, [&] { return allowed_ > 0; });
    --allowed_;
    if (key < 0) return Error{ErrorKind::io, "broken", "file"};
    Picture picture;
    picture.color = Image(10, 10, 4);
    picture.color.pixels.assign(picture.color.pixels.size(), static_cast<float>(key));
    picture.color.pixels.back() = 0.1f;  // no half float: it is kept as it is
    return picture;
  }
  void let(int count) {
    const std::lock_guard lock(mutex_);
    allowed_ += count;
    go_.notify_all();
  }
  /// Blocks until so many have been begun.
  std::vector<int> begun(std::size_t count) {
    std::unique_lock lock(mutex_);
    began_.wait(lock, [&] { return order_.size() >= count; });
    return order_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable go_, began_;
  int allowed_;
  std::vector<int> order_;
};

/// A cache over a Reader that counts what has arrived.
struct Cache {
  Reader reader;
  std::mutex mutex;
  std::condition_variable changed;
  int arrived = 0;
  ReadAhead ahead;

  Cache(std::uint64_t pictures, int threads, bool hold = false)
      : reader(hold),
        ahead([this](int key) { return reader(key); }, {pictures * kPictureBytes, threads},
              [this] {
                const std::lock_guard lock(mutex);
                ++arrived;
                changed.notify_all();
              }) {}
  ~Cache() { reader.let(1 << 20); }
  void wait_for(int count) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return arrived >= count; });
  }
};

TEST(ReadAhead, ReadsTheMostUrgentFirstAndNoMoreThanFits) {
  Cache cache(3, 1);
  cache.ahead.want({5, 6, 7, 8, 9});
  cache.wait_for(3);
  EXPECT_THAT(cache.reader.begun(3), ElementsAre(5, 6, 7));
  const auto stats = cache.ahead.stats();
  EXPECT_EQ(stats.pictures, 3);
  EXPECT_EQ(stats.ahead, 3);
  EXPECT_EQ(stats.bytes, 3 * kPictureBytes);
  EXPECT_EQ(cache.ahead.find(6)->picture.color.pixels[0], 6);
  EXPECT_EQ(cache.ahead.find(8), nullptr);
}

TEST(ReadAhead, WhatIsBehindMakesRoomForWhatIsAhead) {
  Cache cache(3, 2);
  cache.ahead.want({0, 1, 2});
  cache.wait_for(3);
  cache.ahead.want({1, 2, 3});
  cache.ahead.wait(3);
  EXPECT_EQ(cache.ahead.find(0), nullptr);
  EXPECT_NE(cache.ahead.find(1), nullptr);
  EXPECT_NE(cache.ahead.find(2), nullptr);
  EXPECT_EQ(cache.ahead.stats().evicted, 1u);
  EXPECT_LE(cache.ahead.stats().most_bytes, 3 * kPictureBytes);
  EXPECT_EQ(cache.ahead.stats().pixels, 3u * 10 * 10);
}

TEST(ReadAhead, WhatIsWantedLastMakesRoomForWhatIsDue) {
  Cache cache(3, 1);
  cache.ahead.want({0, 1, 2});
  cache.wait_for(3);
  cache.ahead.want({3, 2, 0, 1});
  cache.ahead.wait(3);
  EXPECT_FALSE(cache.ahead.has(1));
  EXPECT_TRUE(cache.ahead.has(0));
  EXPECT_TRUE(cache.ahead.has(2));
}

TEST(ReadAhead, WhatFitsStaysForTheNextLap) {
  Cache cache(4, 2);
  cache.ahead.want({0, 1, 2, 3});
  cache.wait_for(4);
  for (const auto& order : {std::vector<int>{1, 2, 3, 0}, {2, 3, 0, 1}, {3, 0, 1, 2}, {0, 1, 2, 3}}) {
    cache.ahead.want(order);
    for (const int key : order) EXPECT_NE(cache.ahead.find(key), nullptr);
  }
  EXPECT_EQ(cache.ahead.stats().read, 4u) << "nothing was read twice";
}

TEST(ReadAhead, AScrubCancelsWhatMerelyWaits) {
  Cache cache(100, 1, true);
  cache.ahead.want({0, 1, 2, 3, 4});
  cache.reader.begun(1);
  cache.ahead.want({50, 51});
  cache.reader.let(3);
  EXPECT_THAT(cache.reader.begun(3), ElementsAre(0, 50, 51));
  cache.wait_for(3);
  EXPECT_EQ(cache.ahead.find(1), nullptr);
  EXPECT_NE(cache.ahead.find(50), nullptr);
}

TEST(ReadAhead, APictureIsReadOnceThoughManyWantIt) {
  Cache cache(10, 4, true);
  cache.ahead.want({1, 2});
  cache.reader.begun(1);
  cache.ahead.want({1, 2, 3});
  cache.ahead.want({2, 1, 3});
  cache.reader.let(100);
  cache.wait_for(3);
  EXPECT_EQ(cache.reader.begun(3).size(), 3u);
}

TEST(ReadAhead, ErrorsAreKeptWhileWantedAndTriedAgainLater) {
  Cache cache(10, 1);
  cache.ahead.want({-1, 2});
  const auto failed = cache.ahead.wait(-1);
  ASSERT_TRUE(failed->error);
  EXPECT_EQ(failed->error->message, "broken");
  EXPECT_FALSE(cache.ahead.wait(2)->error) << "the others go on";
  cache.ahead.want({-1, 2});
  EXPECT_NE(cache.ahead.find(-1), nullptr);
  cache.ahead.want({2});
  EXPECT_EQ(cache.ahead.find(-1), nullptr);
  cache.ahead.wait(-1);
  EXPECT_EQ(cache.ahead.stats().failed, 2u);
}

TEST(ReadAhead, OnePictureBeyondTheBudgetIsReadAllTheSame) {
  Cache cache(0, 2);
  cache.ahead.want({4, 5, 6});
  EXPECT_EQ(cache.ahead.wait(4)->picture.color.pixels[0], 4);
  cache.ahead.want({5, 6});
  EXPECT_EQ(cache.ahead.wait(5)->picture.color.pixels[0], 5);
  EXPECT_EQ(cache.ahead.stats().pictures, 1);
}

TEST(ReadAhead, ForgettingReadsAgainAndDropsWhatIsOnItsWay) {
  Cache cache(10, 1, true);
  cache.ahead.want({1});
  cache.reader.begun(1);
  cache.ahead.forget();
  cache.reader.let(2);
  EXPECT_THAT(cache.reader.begun(2), ElementsAre(1, 1));
  EXPECT_EQ(cache.ahead.wait(1)->picture.color.pixels[0], 1);
  EXPECT_EQ(cache.ahead.stats().read, 1u);
}

TEST(ReadAhead, HeldPicturesOutliveTheCache) {
  std::shared_ptr<const ReadPicture> held;
  {
    Cache cache(1, 1);
    held = cache.ahead.wait(7);
  }
  EXPECT_EQ(held->picture.color.pixels[0], 7);
}

}  // namespace
}  // namespace afterglow
