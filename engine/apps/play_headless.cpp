// SPDX-License-Identifier: MIT
#include "apps/play_headless.h"

#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <string>

#include "apps/interrupt.h"
#include "image/sequence.h"

namespace afterglow {
namespace {

constexpr double kUntilStopped = std::numeric_limits<double>::infinity();

/// "shot.0004.exr: the header is truncated"
std::string why_text(const Error& error) {
  const std::string name = std::filesystem::path(error.file).filename().string();
  return name.empty() ? error.message : fmt::format("{}: {}", name, error.message);
}

/// The first picture and a good build, before the clock runs.
Result<void> show_first(Player& player) {
  player.settle();
  if (const auto first = player.step(); !first) return first.error();
  if (player.live().stack() == nullptr)
    return player.live().status().error.value_or(Error{ErrorKind::script, "the preset has no good build"});
  if (LiveStack* other = player.other(); other && other->stack() == nullptr)
    return other->status().error.value_or(Error{ErrorKind::script, "the second preset has no good build"});
  if (player.shown().failed) return *player.shown().failed;
  // Builds are complete from here on: that of the first frame has made what it needs.
  player.live().settle();
  return {};
}

}  // namespace

Result<void> play_headless(Player& player, const HeadlessOptions& options) {
  Transport& transport = player.transport();
  transport.set_pacing(options.fast ? Pacing::every_frame : Pacing::real_time, player.now());
  if (!options.count) transport.set_loop(LoopMode::once, player.now());
  if (transport.speed() < 0) transport.go_to_last(player.now());  // where playing backwards begins
  AFTERGLOW_CHECK(show_first(player));
  const bool moves = transport.first() != transport.last();  // one frame stands still however long it is played
  if (moves && (!options.count || *options.count > 1)) transport.play(player.now());
  while (transport.playing()) {
    if (interrupted()) return interrupt_error();
    AFTERGLOW_TRY(const Step step, player.step());
    if (player.shown().failed) return *player.shown().failed;
    if (options.count && player.frames_had() >= *options.count) break;
    if (!step.changed) player.wait(options.fast && transport.playing() ? kUntilStopped : step.next);
  }
  transport.pause(player.now());
  if (interrupted()) return interrupt_error();
  const PlayerStats stats = player.stats();
  if (stats.shown == 0 && player.shown().unreadable) return *player.shown().unreadable;
  if (stats.unreadable > 0)
    return Error{ErrorKind::io,
                 fmt::format("{} of {} frames could not be read: {}; {}", stats.unreadable, player.frames_had(),
                             frames_text(stats.unreadable_frames), why_text(*stats.first_unreadable))};
  return {};
}

}  // namespace afterglow
