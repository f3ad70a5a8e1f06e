// SPDX-License-Identifier: MIT
// Which frame is due when. The clock is a number that the tests set.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "play/transport.h"

namespace afterglow {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Positions due at the starts of `count` frames, from 100 s on; each is shown.
std::vector<int> played(Transport& transport, int count, double frame_seconds) {
  std::vector<int> positions;
  for (int i = 0; i < count; ++i) {
    const auto due = transport.due(100 + i * frame_seconds);
    transport.shown(due);
    positions.push_back(due.position);
  }
  return positions;
}

TEST(Transport, LoopsWithTheClock) {
  Transport transport(3, 24);
  transport.play(100);
  EXPECT_THAT(played(transport, 8, 1.0 / 24), ElementsAre(0, 1, 2, 0, 1, 2, 0, 1));
  EXPECT_EQ(transport.dropped(), 0u);
}

TEST(Transport, PingPongShowsTheTurnsOnce) {
  Transport transport(4, 10);
  transport.set_loop(LoopMode::ping_pong, 0);
  transport.play(100);
  EXPECT_THAT(played(transport, 10, 0.1), ElementsAre(0, 1, 2, 3, 2, 1, 0, 1, 2, 3));
  EXPECT_EQ(transport.heading(), -1);
}

TEST(Transport, OnceStopsAfterTheLastFrameHadItsTime) {
  Transport transport(3, 10);
  transport.set_loop(LoopMode::once, 0);
  transport.play(100);
  EXPECT_THAT(played(transport, 3, 0.1), ElementsAre(0, 1, 2));
  EXPECT_TRUE(transport.playing());
  EXPECT_EQ(transport.due(100.35).position, 2);
  EXPECT_FALSE(transport.playing());
  EXPECT_TRUE(transport.ended());
  transport.play(200);
  EXPECT_EQ(transport.due(200).position, 0) << "begins anew";
  EXPECT_FALSE(transport.ended());
}

TEST(Transport, BackwardsGoesTheOtherWayRoundInEachMode) {
  Transport loop(3, 10);
  loop.set_speed(-1, 0);
  loop.play(100);
  EXPECT_THAT(played(loop, 5, 0.1), ElementsAre(0, 2, 1, 0, 2));
  Transport once(3, 10);
  once.set_loop(LoopMode::once, 0);
  once.set_speed(-1, 0);
  once.play(100);
  EXPECT_THAT(played(once, 4, 0.1), ElementsAre(2, 1, 0, 0)) << "nothing lies before the first: from the last";
  EXPECT_TRUE(once.ended());
  Transport both(3, 10);
  both.set_loop(LoopMode::ping_pong, 0);
  both.go_to(1, 0);
  both.set_speed(-1, 0);
  both.play(100);
  EXPECT_THAT(played(both, 5, 0.1), ElementsAre(1, 0, 1, 2, 1));
}

TEST(Transport, SpeedChangesThePaceAndKeepsThePlace) {
  Transport transport(100, 10);
  transport.play(0);
  EXPECT_EQ(transport.due(0.55).position, 5);
  transport.set_speed(2, 0.55);
  EXPECT_EQ(transport.due(0.57).position, 5) << "half of frame 5 was over: a quarter of 0.1 s is left";
  EXPECT_EQ(transport.due(0.58).position, 6);
  EXPECT_EQ(transport.due(1.08).position, 16);
  transport.set_speed(0.1, 1.08);
  EXPECT_EQ(transport.due(1.08 + 0.85).position, 16) << "a tenth of frame 16 was over";
  EXPECT_EQ(transport.due(1.08 + 0.95).position, 17);
}

TEST(Transport, SpeedIsHeldInItsLimits) {
  Transport transport(10);
  transport.set_speed(100, 0);
  EXPECT_EQ(transport.speed(), 8);
  transport.set_speed(-0.001, 0);
  EXPECT_EQ(transport.speed(), -0.1);
  for (const double wrong : {0.0, std::nan(""), std::numeric_limits<double>::infinity()}) transport.set_speed(wrong, 0);
  EXPECT_EQ(transport.speed(), -0.1);
}

TEST(Transport, LateFramesAreDroppedAndCounted) {
  Transport transport(100, 10);
  transport.play(0);
  transport.shown(transport.due(0));
  transport.shown(transport.due(0.1));
  EXPECT_EQ(transport.dropped(), 0u);
  const auto late = transport.due(0.5);  // 2, 3 and 4 were due meanwhile
  EXPECT_EQ(late.position, 5);
  EXPECT_EQ(transport.dropped(), 0u) << "until another one is shown";
  transport.shown(late);
  EXPECT_EQ(transport.dropped(), 3u);
  transport.due(0.6);  // not read in time: due, but never shown
  transport.shown(transport.due(0.7));
  EXPECT_EQ(transport.dropped(), 4u);
}

TEST(Transport, WhatAJumpPassesOverIsNotDropped) {
  Transport transport(100, 10);
  transport.play(0);
  transport.shown(transport.due(0));
  transport.go_to(50, 0.3);
  EXPECT_TRUE(transport.playing());
  const auto due = transport.due(0.3);
  EXPECT_EQ(due.position, 50);
  EXPECT_TRUE(due.moved);
  transport.shown(due);
  transport.shown(transport.due(0.4));
  EXPECT_EQ(transport.position(), 51);
  EXPECT_EQ(transport.dropped(), 0u);
}

TEST(Transport, EveryFrameIgnoresTheClock) {
  Transport transport(3, 24);
  transport.set_loop(LoopMode::once, 0);
  transport.set_pacing(Pacing::every_frame, 0);
  transport.play(0);
  std::vector<int> positions;
  for (int i = 0; i < 3; ++i) {
    const auto due = transport.due(i * 1000.0);
    EXPECT_EQ(transport.due(i * 1000.0 + 1).position, due.position) << "the same until it is shown";
    transport.shown(due);
    positions.push_back(due.position);
  }
  EXPECT_THAT(positions, ElementsAre(0, 1, 2));
  transport.due(5000);
  EXPECT_TRUE(transport.ended());
  EXPECT_EQ(transport.dropped(), 0u);
}

TEST(Transport, StepsPauseAndFollowTheLoopMode) {
  Transport transport(30, 10);
  transport.play(0);
  transport.step(1, 0.5);
  EXPECT_FALSE(transport.playing());
  EXPECT_EQ(transport.position(), 6);
  transport.step(-10, 0.5);
  EXPECT_EQ(transport.position(), 26) << "round the end";
  transport.set_loop(LoopMode::once, 1);
  transport.step(10, 1);
  EXPECT_EQ(transport.position(), 29) << "held at the end";
  EXPECT_EQ(transport.due(50).position, 29);
}

TEST(Transport, RangeBoundsPlayingNotScrubbing) {
  Transport transport(100, 10);
  transport.set_range(20, 10, 0);
  EXPECT_EQ(transport.position(), 10);
  EXPECT_EQ(transport.last(), 20);
  transport.go_to_last(0);
  transport.play(100);
  EXPECT_THAT(played(transport, 3, 0.1), ElementsAre(20, 10, 11));
  transport.pause(100.3);
  transport.go_to(50, 101);
  EXPECT_EQ(transport.due(101).position, 50);
  transport.play(100);
  EXPECT_EQ(transport.due(100).position, 10) << "playing begins in the range";
  transport.clear_range(100);
  EXPECT_EQ(transport.last(), 99);
  transport.set_range(-5, 1000, 100);
  EXPECT_EQ(transport.first(), 0);
  EXPECT_EQ(transport.last(), 99);
}

TEST(Transport, KnowsWhenTheNextFrameIsDue) {
  Transport transport(10, 10);
  EXPECT_EQ(transport.next_due(), std::numeric_limits<double>::infinity());
  transport.play(5);
  EXPECT_NEAR(transport.next_due(), 5.1, 1e-9);
  transport.due(5.25);
  EXPECT_NEAR(transport.next_due(), 5.3, 1e-9);
}

TEST(Transport, KnowsWhatComesNext) {
  Transport transport(5, 10);
  transport.go_to(3, 0);
  EXPECT_THAT(transport.upcoming(3), ElementsAre(4, 0, 1));
  EXPECT_THAT(transport.upcoming(100), ElementsAre(4, 0, 1, 2)) << "each once, without the present one";
  transport.set_loop(LoopMode::ping_pong, 0);
  EXPECT_THAT(transport.upcoming(3), ElementsAre(4, 2, 1));
  transport.set_loop(LoopMode::once, 0);
  EXPECT_THAT(transport.upcoming(3), ElementsAre(4));
  transport.set_speed(-1, 0);
  EXPECT_THAT(transport.upcoming(9), ElementsAre(2, 1, 0));
  transport.set_speed(8, 0);
  transport.set_loop(LoopMode::loop, 0);
  EXPECT_THAT(transport.upcoming(2, 2), ElementsAre(0, 2));
  EXPECT_THAT(Transport(1).upcoming(4), IsEmpty());
}

TEST(Transport, OneFrameStaysInEveryMode) {
  for (const LoopMode mode : {LoopMode::once, LoopMode::loop, LoopMode::ping_pong}) {
    Transport transport(1, 10);
    transport.set_loop(mode, 0);
    transport.play(0);
    EXPECT_EQ(transport.due(12.3).position, 0);
    transport.step(-10, 13);
    EXPECT_EQ(transport.due(13).position, 0);
  }
}

TEST(Transport, LoopModesHaveNames) {
  for (const LoopMode mode : {LoopMode::once, LoopMode::loop, LoopMode::ping_pong})
    EXPECT_EQ(parse_loop_mode(loop_mode_name(mode)).value(), mode);
  EXPECT_EQ(parse_loop_mode("pingpong").error().text(),
            "--loop: error: 'pingpong' is no loop mode; allowed: once, loop, ping-pong; did you mean 'ping-pong'?");
}

}  // namespace
}  // namespace afterglow
