// SPDX-License-Identifier: MIT
#include "apps/play_window.h"

#include "apps/interrupt.h"
#include "core/stopwatch.h"
#include "window/play_parts.h"
#include "window/run_window.h"

namespace afterglow {

namespace {

constexpr Size kFirstSize{1440, 900};  // pixels of a plain display

WindowOptions window_options(const PlayWindowOptions& options) {
  WindowOptions out;
  if (options.scale) out.scale = static_cast<float>(*options.scale);
  out.full_screen = options.full_screen;
  out.stats = options.stats;
  out.display = options.display;
  out.make_display = options.make_display;
  out.interrupted = [] { return interrupted(); };
  return out;
}

}  // namespace

Result<void> play_in_window(
    PlayerOptions player_options, DeviceOptions device_options, const PlayWindowOptions& options, Console& console,
    const std::function<void(const Device&, Player&, const PlayedTimes&, const Result<void>& done)>& at_end) {
  const auto start = Clock::now();
  install_interrupt_handler();
  const auto place = options.place ? options.place : remembered_place();
  AFTERGLOW_TRY(const auto window,
                DesktopWindow::create("Afterglow", place ? place->size : kFirstSize, place.has_value()));
  if (place && place->placed) window->move_to(place->x, place->y);
  const DeviceOptions export_device = device_options;  // no window is shown on that
  device_options.presentation = window->presentation();
  AFTERGLOW_TRY(const auto device, Device::create(device_options, console.diagnostics()));
  player_options.footage.whole_sequences = true;
  player_options.wake = &DesktopWindow::wake;
  player_options.finite_watch = {.device = export_device};
  Result<void> done;
  {
    AFTERGLOW_TRY(const auto player, Player::open(*device, player_options, console.diagnostics()));
    player->transport().set_speed(options.speed, player->now());
    // A frame that was asked for is what is looked at.
    const bool stands = player->footage_options().inputs != player_options.footage.inputs;
    if (!options.paused && !stands && player->footage().frames() > 1) player->transport().play(player->now());
    WindowOptions shown = window_options(options);
    shown.check = device_options.validate;
    PlayParts parts(*player,
                    {.preset = player_options.preset,
                     .device = export_device,
                     .stack = player_options.live.stack,
                     .to = options.exports},
                    console.diagnostics());
    parts.add_to(shown);
    PlayedTimes times{.startup = milliseconds_since(start)};
    const auto began = Clock::now();
    const auto tell = [&](const Result<void>& outcome) {
      times.wall = milliseconds_since(began);
      at_end(*device, *player, times, outcome);
    };
    window->set_last_words([&] { tell(Error{ErrorKind::device, "the connection to the display was lost"}); });
    done = run_window(*window, *device, *player, shown, console.diagnostics());
    window->set_last_words(nullptr);
    const Rect left = window->place();
    if (done && !options.place && left.size().area() > 0) remember_place({left.size(), true, left.x, left.y});
    tell(done);
  }
  // Validation goes first: it says what a failure comes from.
  if (device->validation_errors() > 0) {
    return Error{ErrorKind::device, "Vulkan validation: " + device->validation_messages().front()};
  }
  if (done && interrupted()) return interrupt_error();
  return done;
}

}  // namespace afterglow
