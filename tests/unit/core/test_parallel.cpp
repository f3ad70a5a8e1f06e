// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/parallel.h"
#include "core/spares.h"

namespace afterglow {
namespace {

TEST(ParallelFor, EachOnce) {
  for (const std::size_t count : {0u, 1u, 2u, 1000u}) {
    std::vector<std::atomic<int>> visits(count);
    parallel_for(count, [&](std::size_t i) { ++visits[i]; });
    for (const auto& visit : visits) EXPECT_EQ(visit, 1);
  }
}

TEST(ParallelFor, AnExceptionOfAnyThreadEndsTheLoop) {
  std::atomic<std::size_t> done{0};
  const auto work = [&](std::size_t i) {
    if (i % 2 == 1) throw std::runtime_error("odd");
    ++done;
  };
  EXPECT_THROW(parallel_for(1'000'000, work), std::runtime_error);
  EXPECT_LT(done, 500'000u);
}

TEST(ParallelTasks, EachOnceAndTheFirstExceptionIsThrown) {
  std::vector<std::atomic<int>> visits(100);
  parallel_tasks(visits.size(), [&](std::size_t i) { ++visits[i]; });
  for (const auto& visit : visits) EXPECT_EQ(visit, 1);
  EXPECT_THROW(parallel_tasks(100,
                              [](std::size_t i) {
                                if (i == 7) throw std::runtime_error("seven");
                              }),
               std::runtime_error);
}

TEST(ParallelFor, NobodyHelpsAThreadThatLoopsAlone) {
  std::jthread([] {
    loop_alone();
    const auto own = std::this_thread::get_id();
    parallel_for(1000, [&](std::size_t) { EXPECT_EQ(std::this_thread::get_id(), own); });
  });
}

TEST(ParallelFor, HelpersHearNoSignals) {
  parallel_for(100'000, [caller = std::this_thread::get_id()](std::size_t) {
    sigset_t blocked;
    pthread_sigmask(SIG_BLOCK, nullptr, &blocked);
    EXPECT_EQ(sigismember(&blocked, SIGTERM), std::this_thread::get_id() == caller ? 0 : 1);
  });
}

TEST(ParallelFor, LoopsInLoopsAndOfManyThreadsEnd) {
  std::atomic<int> visits = 0;
  std::vector<std::jthread> callers;
  for (int k = 0; k < 6; ++k)
    callers.emplace_back([&] {
      for (int i = 0; i < 200; ++i)
        parallel_for(7, [&](std::size_t) { parallel_for(3, [&](std::size_t) { ++visits; }); });
    });
  callers.clear();
  EXPECT_EQ(visits, 6 * 200 * 7 * 3);
}

#ifndef __SANITIZE_THREAD__  // which allows such children no threads

/// The threads are the parent's, and in the middle of something.
TEST(ParallelFor, AChildOfForkMakesThreadsOfItsOwn) {
  std::atomic<bool> done = false;
  std::jthread other([&] {
    while (!done) parallel_for(20, [](std::size_t) {});
  });
  for (int i = 0; i < 20; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      std::atomic<int> visits = 0;
      parallel_for(1000, [&](std::size_t) { ++visits; });
      _exit(visits == 1000 ? 0 : 1);
    }
    int status = -1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  }
  done = true;
}

#endif

TEST(Spares, AreMadeForThoseThatWorkAtATimeAndKeepWhatTheyHold) {
  struct Thing {
    std::atomic<bool> used = false;
    int uses = 0;
  };
  std::atomic<int> made = 0, now = 0, most = 0, uses = 0, shared = 0;
  Spares<Thing> spares;
  const auto make = [&] {
    ++made;
    return std::make_unique<Thing>();
  };
  for (int round = 0; round < 3; ++round)
    parallel_for(100, [&](std::size_t) {
      const int here = ++now;
      for (int before = most; before < here && !most.compare_exchange_weak(before, here);) {
      }
      {
        const auto thing = spares.borrow(make);
        if (thing->used.exchange(true)) ++shared;
        ++thing->uses;
        thing->used = false;
      }
      --now;
    });
  EXPECT_EQ(shared, 0) << "two had the same one";
  EXPECT_LE(made, most);
  std::vector<std::unique_ptr<Spares<Thing>::Borrowed>> all;
  for (int i = made; i > 0; --i) {
    all.push_back(std::unique_ptr<Spares<Thing>::Borrowed>(new Spares<Thing>::Borrowed(spares.borrow(make))));
    uses += (*all.back())->uses;
  }
  EXPECT_EQ(uses, 300);
}

TEST(Spares, ComeBackWhenTheirUserFails) {
  int made = 0;
  Spares<int> spares;
  const auto make = [&] { return std::make_unique<int>(++made); };
  try {
    const auto one = spares.borrow(make);
    *one = 7;
    throw std::runtime_error("in between");
  } catch (const std::runtime_error&) {
  }
  EXPECT_EQ(*spares.borrow(make), 7);
  EXPECT_EQ(made, 1);
}

}  // namespace
}  // namespace afterglow
