// SPDX-License-Identifier: MIT
// `afterglow play`: footage through a preset that is being edited.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <memory>
#include <utility>

#include "apps/command.h"
#include "apps/output.h"
#include "apps/play_arguments.h"
#include "apps/play_headless.h"
#include "apps/play_report.h"
#include "apps/play_settings.h"
#include "apps/play_window.h"
#include "core/file.h"
#include "core/file_record.h"
#include "core/stopwatch.h"
#include "core/written_files.h"
#include "image/writer.h"

namespace afterglow {
namespace {

/// Writes the file of --report, once there are figures; `reported` then.
Result<void> write_report(const PlayArguments& a, const std::string& text, bool& reported) {
  if (a.report.empty()) return {};
  reported = true;
  return output_file(a.report, text);
}

/// What is written besides must be nothing that is played. `look`: files of the presets.
Result<void> check_written_files(const PlayArguments& a, const Footage* footage,
                                 std::vector<std::filesystem::path> look) {
  const std::array sides{SideFile{"--screenshot", a.screenshot, FileForm::any}, SideFile{"--report", a.report}};
  for (int picture = 0; footage && picture < footage->pictures(); ++picture)
    if (picture == 0 || !footage->movie(picture) || footage->file(picture) != footage->file(picture - 1))
      std::ranges::move(footage->files(picture), std::back_inserter(look));
  return check_written(sides, {}, look);
}

/// Of presets that may still be broken: looks at the pictures anew, and only when something is to be written.
Result<void> check_written_files(const PlayArguments& a, const PlayerOptions& options) {
  if (a.report.empty() && a.screenshot.empty()) return {};
  Diagnostics quiet;  // they are told of when they are played, and what is wrong with them
  const auto footage = Footage::open(options.footage, quiet);
  std::vector<std::filesystem::path> look{options.preset, options.other_preset};
  if (!footage) look.insert(look.end(), options.footage.inputs.begin(), options.footage.inputs.end());
  return check_written_files(a, footage ? footage->get() : nullptr, std::move(look));
}

/// By now the preset has said what it reads.
Result<void> write_screenshot(const PlayArguments& a, Player& player, Console& console) {
  AFTERGLOW_TRY(const Picture picture, player.screenshot());
  if (Stack* const stack = player.live().stack())
    AFTERGLOW_CHECK(check_written_files(a, &player.footage(), looked_at(*stack->preset().probes())));
  return write_picture(picture, a.screenshot, {}, console.diagnostics());
}

Result<void> play_without_window(const PlayArguments& a, const PlayerOptions& options, Console& console,
                                 bool& reported) {
  const auto start = Clock::now();
  AFTERGLOW_TRY(const DeviceOptions asked, a.device.options());
  AFTERGLOW_TRY(const auto device, Device::create(asked, console.diagnostics()));
  PlayerOptions watched = options;
  watched.finite_watch = {.device = asked, .until_asked = true};
  AFTERGLOW_TRY(const auto player, Player::open(*device, watched, console.diagnostics()));
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
  if (done) player->finish_finite_watch();
  if (done) done = a.check_shown(*player);  // it would show the result in its place
  // Validation goes first: it says what a failure comes from.
  if (device->validation_errors() > 0)
    done = Error{ErrorKind::device, "Vulkan validation: " + device->validation_messages().front()};
  if (!done) report.error = done.error();
  if (done && !a.screenshot.empty()) {
    done = write_screenshot(a, *player, console);
  }
  if (a.stats) output("{}", play_report_text(report, *player));
  auto written = write_report(a, play_report_json(report, *player), reported);
  return done ? written : done;
}

Result<void> play_with_window(const PlayArguments& a, const PlayerOptions& options, Console& console, bool& reported) {
  std::optional<WindowPlace> place;
  if (!a.geometry.empty()) {
    AFTERGLOW_TRY(place, parse_geometry(a.geometry));
  }
  AFTERGLOW_TRY(auto display, a.shown_on.shown(options.preset, a.preset.paths));
  const auto make_display = [&](const std::string& name, const std::string& view) -> Result<ShownDisplay> {
    DisplayArguments wanted = a.shown_on;
    if (wanted.profile.empty()) wanted.display = name, wanted.view = view;
    AFTERGLOW_TRY(auto made, wanted.shown(options.preset, a.preset.paths));
    return made ? Result<ShownDisplay>(*std::move(made)) : Error{ErrorKind::other, "no display is named"};
  };
  const PlayWindowOptions window{.place = place,
                                 .scale = a.ui_scale,
                                 .full_screen = a.full_screen,
                                 .paused = a.paused,
                                 .stats = a.stats,
                                 .speed = a.speed,
                                 .display = std::move(display),
                                 .make_display = make_display,
                                 .exports = a.exports};
  Result<void> written;
  const auto report = [&](const Device& device, Player& player, const PlayedTimes& times, const Result<void>& done) {
    PlayReport figures{.preset = options.preset.string(),
                       .device = device.info().name,
                       .driver = device.info().driver,
                       .mode = "window",
                       .startup = times.startup,
                       .wall = times.wall,
                       .error = {}};
    if (!done) figures.error = done.error();
    if (a.stats) output("{}", play_report_text(figures, player));
    written = write_report(a, play_report_json(figures, player), reported);
  };
  AFTERGLOW_TRY(const DeviceOptions asked, a.device.options());
  AFTERGLOW_CHECK(play_in_window(options, asked, window, console, report));
  return written;
}

/// What the user wants of every window. Runs without one are scripts', and the same for everybody.
Result<void> take_settings(CLI::App& app, const PlayArguments& a) {
  const auto file = play_settings_file();
  std::error_code none;
  if (a.headless || file.empty() || !std::filesystem::exists(file, none)) return {};
  AFTERGLOW_TRY(const std::string text, read_file(file));
  return apply_play_settings(app, text, file.string());
}

Result<void> play_command(CLI::App& app, const PlayArguments& a, Console& console) {
  AFTERGLOW_CHECK(take_settings(app, a));
  keep_standard_output_for({a.report});
  AFTERGLOW_TRY(const PlayerOptions options, a.player());
  a.preset.tell_of_namesake(options.preset, console.diagnostics());
  AFTERGLOW_CHECK(check_written_files(a, options));
  bool reported = false;
  auto done =
      a.headless ? play_without_window(a, options, console, reported) : play_with_window(a, options, console, reported);
  if (!done && !reported) (void)write_report(a, play_failure_json(options.preset.string(), done.error()), reported);
  return done;
}

}  // namespace

Command add_play_command(CLI::App& program) {
  auto* app = program.add_subcommand("play", "Play pictures through a preset that is being edited");
  auto arguments = std::make_shared<PlayArguments>();
  arguments->add(*app);
  app->footer(
      "Examples:\n"
      "  afterglow play look.lua shot.####.exr\n"
      "  afterglow play look.lua clip.mp4 --b other.lua --loop ping-pong\n"
      "  afterglow play look.lua shot.####.exr --headless --count 240 --stats --report play.json\n"
      "  afterglow play look.lua shot.####.exr --headless --fast --frames 12 --screenshot shot.0012.png");
  return {app, [app, arguments](Console& console) { return play_command(*app, *arguments, console); }};
}

}  // namespace afterglow
