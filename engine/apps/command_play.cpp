// SPDX-License-Identifier: MIT
// `afterglow play`: footage through a preset that is being edited.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "apps/command.h"
#include "apps/options.h"
#include "apps/output.h"
#include "apps/play_headless.h"
#include "apps/play_report.h"
#include "apps/play_window.h"
#include "core/file.h"
#include "core/paths.h"
#include "core/stopwatch.h"
#include "core/text.h"
#include "image/writer.h"
#include "play/player.h"

namespace afterglow {
namespace {

struct PlayArguments {
  PresetArguments preset;
  DeviceArguments device;
  ExecutionArguments execution;
  std::vector<std::string> inputs;
  LayerArguments layers;
  std::string frames;
  std::string other, show, loop, cache = "2G", screenshot, report;
  std::optional<double> fps;
  double speed = 1;
  int readers = 2;
  std::uint64_t count = 0;
  bool full_screen = false, paused = false;
  std::optional<double> ui_scale;
  bool headless = false, fast = false, real_time = false, stats = false, poll = false;
};

void add_input(CLI::App& app, PlayArguments& a) {
  app.add_option("INPUT", a.inputs,
                 "Pictures, sequences like shot.####.exr and shot.%04d.exr, videos (MP4, QuickTime, AVI)")
      ->required();
  const std::string group = "Input";
  app.add_option("--frames", a.frames,
                 "Frames to play: 1-24, 1-24x2, 1,5,10-12 (default: all; missing ones hold the one before)")
      ->type_name("LIST")
      ->group(group);
  a.layers.add(app);
  app.add_option("--cache", a.cache, "Memory for pictures read ahead (default 2G)")->type_name("SIZE")->group(group);
  app.add_option("--readers", a.readers, "Threads that read ahead (default 2)")
      ->check(CLI::Range(1, 64))
      ->type_name("N")
      ->group(group);
}

void add_playing(CLI::App& app, PlayArguments& a) {
  const std::string group = "Playing", headless = "Without a window";
  app.add_option("--fps", a.fps, "Frames a second (default: the video's, else 24)")
      ->check(CLI::PositiveNumber)
      ->type_name("N")
      ->group(group);
  app.add_option("--speed", a.speed, "0.1 to 8, below 0 backwards (default 1)")->type_name("X")->group(group);
  app.add_option("--loop", a.loop, "loop (default), once or ping-pong")->type_name("MODE")->group(group);
  app.add_option("--b", a.other, "A second preset to compare with")->type_name("PRESET")->group(group);
  app.add_option("--show", a.show,
                 "An image between passes instead of the result: 'source', a pass's name (see `graph`)")
      ->type_name("IMAGE")
      ->group(group);
  app.add_flag("--poll", a.poll, "Look at files regularly instead of waiting for the system to tell of changes")
      ->group(group);
  const std::string window = "Window";
  app.add_flag("--full-screen", a.full_screen, "Fill the screen")->group(window);
  app.add_flag("--paused", a.paused, "Begin with the first frame, standing still")->group(window);
  app.add_option("--ui-scale", a.ui_scale, "Size of the interface, 0.5 to 4 (default: the desktop's)")
      ->check(CLI::Range(0.5, 4.0))
      ->type_name("X")
      ->group(window);
  app.add_flag("--headless", a.headless, "Play without a window, and end")->group(headless);
  app.add_option("--count", a.count, "Frames to play, looping as --loop says (default: each once)")
      ->check(CLI::PositiveNumber)
      ->type_name("N")
      ->group(headless);
  auto* real_time =
      app.add_flag("--real-time", a.real_time, "By the clock, dropping what comes too late (default)")->group(headless);
  app.add_flag("--fast", a.fast, "Every frame, as fast as possible")->group(headless)->excludes(real_time);
  app.add_option("--screenshot", a.screenshot, "Write the last frame that was shown")
      ->type_name("FILE")
      ->group(headless);
  app.add_flag("--stats", a.stats, "Print frame times, drops, and the latency of reloads")->group("Messages");
  app.add_option("--report", a.report, "Write them as JSON")->type_name("FILE.json")->group("Messages");
}

Result<PlayerOptions> player_options(const PlayArguments& a) {
  PlayerOptions options;
  AFTERGLOW_TRY(options.live.stack, a.execution.options());
  AFTERGLOW_TRY(options.live.stack.preset, a.preset.options());
  AFTERGLOW_TRY(options.preset, a.preset.preset_file());
  if (!a.other.empty()) {
    AFTERGLOW_TRY(options.other_preset, find_preset_file(a.other, {a.preset.paths.begin(), a.preset.paths.end()}));
  }
  options.live.watch.poll = a.poll;
  options.footage.inputs = a.inputs;
  options.footage.frames = a.frames;
  options.footage.read.layer = a.layers.layer;
  options.footage.read.max_bytes = options.live.stack.max_memory;
  a.layers.choose(options.footage.read);
  auto cache = parse_memory(a.cache);
  if (!cache) {
    Error error = std::move(cache).error();
    error.file = "--cache";
    return error;
  }
  options.read_ahead = {cache.value(), a.readers};
  options.fps = a.fps;
  if (!a.loop.empty()) {
    AFTERGLOW_TRY(options.loop, parse_loop_mode(a.loop));
  }
  if (!(std::abs(a.speed) >= Transport::kSlowest && std::abs(a.speed) <= Transport::kFastest))
    return Error{ErrorKind::usage, fmt::format("'{}' is no speed", a.speed), "--speed", 0, "0.1 to 8, -0.1 to -8"};
  if (a.headless && !a.loop.empty() && options.loop != LoopMode::once && a.count == 0)
    return Error{ErrorKind::usage, fmt::format("--loop {} without a window needs an end: --count N", a.loop),
                 "afterglow play"};
  if (!a.headless && (a.count > 0 || a.fast || a.real_time || !a.screenshot.empty()))
    return Error{ErrorKind::usage, "--count, --fast, --real-time and --screenshot go with --headless",
                 "afterglow play"};
  options.show = a.show;
  return options;
}

/// `write_picture` finds the format by the extension: wrong ones are refused before any work.
Result<void> check_screenshot(const PlayArguments& a) {
  return a.screenshot.empty() ? Result<void>{} : check_output(a.screenshot, {});
}

/// An image between passes that is not there would show the result in its place.
Result<void> check_shown(const PlayArguments& a, Player& player) {
  if (a.show.empty()) return {};
  const std::vector<std::string> images = player.live().images();
  if (images.empty() || std::ranges::find(images, a.show) != images.end()) return {};
  return Error{ErrorKind::usage, fmt::format("there is no image '{}'", a.show),
               "--show",         0,
               join(images),     nearest_name(a.show, images)};
}

Result<void> play_without_window(const PlayArguments& a, const PlayerOptions& options, Console& console) {
  const auto start = Clock::now();
  AFTERGLOW_TRY(const DeviceOptions asked, a.device.options());
  AFTERGLOW_TRY(const auto device, Device::create(asked, console.diagnostics()));
  AFTERGLOW_TRY(const auto player, Player::open(*device, options, console.diagnostics()));
  player->transport().set_speed(a.speed, player->now());
  HeadlessOptions headless;
  headless.fast = a.fast;
  if (a.count > 0) headless.count = a.count;

  PlayReport report{.preset = options.preset.string(),
                    .device = device->info().name,
                    .driver = device->info().driver,
                    .mode = a.fast ? "fast" : "real time",
                    .startup = milliseconds_since(start),
                    .error = {}};
  const auto began = Clock::now();
  auto done = play_headless(*player, headless);
  report.wall = milliseconds_since(began);
  if (done) done = check_shown(a, *player);
  // Validation goes first: it says what a failure comes from.
  if (device->validation_errors() > 0)
    done = Error{ErrorKind::device, "Vulkan validation: " + device->validation_messages().front()};
  if (!done) report.error = done.error();
  if (done && !a.screenshot.empty()) {
    auto picture = player->screenshot();
    done = picture ? write_picture(*picture, a.screenshot, {}, console.diagnostics()) : Result<void>(picture.error());
  }
  if (a.stats) output("{}", play_report_text(report, *player));
  if (!a.report.empty()) {
    auto written = write_file_atomically(a.report, play_report_json(report, *player));
    if (done && !written) return written;
  }
  return done;
}

Result<void> play_with_window(const PlayArguments& a, const PlayerOptions& options, Console& console) {
  const PlayWindowOptions window{
      .scale = a.ui_scale, .full_screen = a.full_screen, .paused = a.paused, .stats = a.stats, .speed = a.speed};
  Result<void> reported;
  const auto report = [&](const Device& device, Player& player, const Result<void>& done) {
    PlayReport figures{.preset = options.preset.string(),
                       .device = device.info().name,
                       .driver = device.info().driver,
                       .mode = "window",
                       .error = {}};
    if (!done) figures.error = done.error();
    if (a.stats) output("{}", play_report_text(figures, player));
    if (!a.report.empty()) reported = write_file_atomically(a.report, play_report_json(figures, player));
  };
  AFTERGLOW_TRY(const DeviceOptions asked, a.device.options());
  AFTERGLOW_CHECK(play_in_window(options, asked, window, console, report));
  return reported;
}

Result<void> play_command(const PlayArguments& a, Console& console) {
  AFTERGLOW_TRY(const PlayerOptions options, player_options(a));
  AFTERGLOW_CHECK(check_screenshot(a));
  if (a.headless) return play_without_window(a, options, console);
  return play_with_window(a, options, console);
}

}  // namespace

Command add_play_command(CLI::App& program) {
  auto* app = program.add_subcommand("play", "Play pictures through a preset that is being edited");
  auto arguments = std::make_shared<PlayArguments>();
  arguments->preset.add(*app);
  add_input(*app, *arguments);
  add_playing(*app, *arguments);
  arguments->device.add(*app);
  arguments->execution.add(*app);
  app->footer(
      "Examples:\n"
      "  afterglow play look.lua shot.####.exr\n"
      "  afterglow play look.lua clip.mp4 --b other.lua --loop ping-pong\n"
      "  afterglow play look.lua shot.####.exr --headless --count 240 --stats --report play.json\n"
      "  afterglow play look.lua shot.####.exr --headless --fast --frames 12 --screenshot shot.0012.png");
  return {app, [arguments](Console& console) { return play_command(*arguments, console); }};
}

}  // namespace afterglow
