// SPDX-License-Identifier: MIT
#include "apps/farm_wait.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>

#include "apps/interrupt.h"
#include "core/stopwatch.h"
#include "farm/status.h"

namespace afterglow {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFirstPause{100}, kLongestPause{5000};  // Slurm is asked once a pause
constexpr milliseconds kStep{50};                              // until a signal is heard
constexpr double kWithoutAnswer = 600'000;  // ms: a Slurm that is busy or begins again answers by then
constexpr double kReportsBy = 90'000;       // ms that network file systems may keep a new file to themselves

/// False when it was interrupted.
bool pause(milliseconds length) {
  for (milliseconds waited{0}; waited < length && !interrupted(); waited += kStep) std::this_thread::sleep_for(kStep);
  return !interrupted();
}

Error waited_no_longer(const farm::Job& job) {
  return {ErrorKind::interrupted, "waited no longer; the job goes on", job.folder.string(), 0,
          "`afterglow farm cancel` to end it"};
}

}  // namespace

Result<void> wait_for_job(const farm::Job& job, Console& console) {
  const auto start = Clock::now();
  std::optional<Clock::time_point> answered;    // that Slurm is there is seen at once
  Clock::time_point other_than_ending = start;  // when a chunk was last seen to wait or run
  for (milliseconds length = kFirstPause;; length = std::min(length * 3 / 2, kLongestPause)) {
    const auto asked = farm::status_of(job);
    if (asked) {
      answered = Clock::now();
    } else if (!answered || milliseconds_since(*answered) > kWithoutAnswer) {
      console.end_progress();
      return asked.error();
    } else {
      console.diagnostics().warn_once("slurm", asked.error().text() + "; it is asked again");
      if (pause(length)) continue;
      console.end_progress();
      return waited_no_longer(job);
    }
    const farm::JobStatus& status = *asked;
    console.progress(status.frames_done, status.frames, farm::waiting_line(job, status),
                     milliseconds_since(start) / 1000);
    const bool ending = status.count(farm::ChunkStatus::State::ending) > 0 &&
                        status.count(farm::ChunkStatus::State::running) == 0 &&
                        status.count(farm::ChunkStatus::State::waiting) == 0;
    if (!ending) other_than_ending = Clock::now();
    const bool given_up = milliseconds_since(other_than_ending) > kReportsBy;
    if (!status.live() || given_up) {
      console.end_progress();
      return farm::outcome_of(job, status);
    }
    if (!pause(length)) {
      console.end_progress();
      return waited_no_longer(job);
    }
  }
}

}  // namespace afterglow
