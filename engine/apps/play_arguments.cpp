// SPDX-License-Identifier: MIT
#include "apps/play_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/window_place.h"
#include "batch/batch_run.h"
#include "core/file.h"
#include "core/paths.h"
#include "core/text.h"
#include "image/input_space.h"
#include "image/writer.h"

namespace afterglow {

void PlayArguments::add(CLI::App& app) {
  preset.add(app);
  add_input(app);
  add_playing(app);
  device.add(app);
  execution.add(app);
}

void PlayArguments::add_input(CLI::App& app) {
  app.add_option("INPUT", inputs,
                 "Pictures, sequences like shot.####.exr and shot.%04d.exr, folders that hold one, videos")
      ->required();
  const std::string group = "Input";
  app.add_option("--frames", frames,
                 "Frames to play: 1-24, 1-24x2, 1,5,10-12 (default: all; missing ones hold the one before)")
      ->type_name("LIST")
      ->group(group);
  add_cuts(app, cuts, group);
  layers.add(app);
  app.add_option("--proxy", proxy, "Read pictures at 1/2, 1/4 or 1/8 of their sides; what is written is whole")
      ->type_name("SIZE")
      ->group(group);
  app.add_option("--cache", cache, "Memory for pictures read ahead (default 2G)")->type_name("SIZE")->group(group);
  app.add_option("--readers", readers, "Threads that read ahead (default: half of the processors, 2 to 8)")
      ->check(CLI::Range(1, 64))
      ->type_name("N")
      ->group(group);
}

void PlayArguments::add_playing(CLI::App& app) {
  const std::string group = "Playing", alone = "Without a window";
  app.add_option("--fps", fps, "Frames a second (default: the video's, else 24)")
      ->transform(frame_rates())
      ->type_name("N")
      ->group(group);
  app.add_option("--speed", speed, "0.1 to 8, below 0 backwards (default 1)")->type_name("X")->group(group);
  app.add_option("--loop", loop, "loop (default), once or ping-pong")->type_name("MODE")->group(group);
  app.add_option("--b", other, "A second preset to compare with")->type_name("PRESET")->group(group);
  app.add_option("--show", show, "An image between passes instead of the result: 'source', a pass's name (see `graph`)")
      ->type_name("IMAGE")
      ->group(group);
  app.add_flag("--poll", poll, "Look at files regularly instead of waiting for the system to tell of changes")
      ->group(group);
  const std::string window = "Window";
  app.add_flag("--full-screen,--fullscreen", full_screen, "Fill the screen")->group(window);
  app.add_option("--geometry", geometry, "Size of the window, and its place: 1280x720+100+50 (default: as it was left)")
      ->type_name("WxH[+X+Y]")
      ->group(window);
  app.add_flag("--mute", mute, "Videos are silent; U lets them be heard")->group(window);
  app.add_option("--volume", volume, "How loud videos are, 0 to 100 (default 100)")
      ->check(CLI::Range(0.0, 100.0))
      ->type_name("PERCENT")
      ->group(window);
  app.add_flag("--paused", paused, "Begin with the first frame, standing still")->group(window);
  app.add_option("--ui-scale", ui_scale, "Size of the interface, 0.5 to 4 (default: the desktop's)")
      ->check(CLI::Range(0.5, 4.0))
      ->type_name("X")
      ->group(window);
  shown_on.add(app);
  app.add_option(
         "--export", exports,
         "Where S writes the frame, and Ctrl+R the range, full size: a file, a pattern like out.####.png, a folder "
         "or a video (default: NAME_graded.exr here)")
      ->type_name("OUTPUT")
      ->group(window);
  app.add_flag("--headless", headless, "Play without a window, and end")->group(alone);
  app.add_option("--count", count,
                 "Frames to play, looping as --loop says (default: each once; loop and ping-pong need it)")
      ->check(above_zero())
      ->type_name("N")
      ->group(alone);
  auto* clock =
      app.add_flag("--real-time", real_time, "By the clock, dropping what comes too late (default)")->group(alone);
  app.add_flag("--fast", fast, "Every frame, as fast as possible")->group(alone)->excludes(clock);
  app.add_option("--screenshot", screenshot, "Write the last frame that was shown")->type_name("FILE")->group(alone);
  app.add_flag("--stats", stats, "Print frame times, drops, and the latency of reloads")->group("Messages");
  app.add_option("--report", report, "Write them as JSON")->type_name("FILE.json")->group("Messages");
}

Result<void> PlayArguments::check() const {
  if (!(std::abs(speed) >= Transport::kSlowest && std::abs(speed) <= Transport::kFastest))
    return Error{ErrorKind::usage, fmt::format("'{}' is no speed", speed), "--speed", 0, "0.1 to 8, -0.1 to -8"};
  if (std::ranges::count(inputs, "-") > 0)
    return Error{ErrorKind::usage, "standard input cannot be played: playback goes back and forth", "afterglow play", 0,
                 "files; `afterglow run` takes -"};
  if (!geometry.empty()) AFTERGLOW_CHECK(parse_geometry(geometry));
  if (headless && !loop.empty() && loop != "once" && count == 0)
    return Error{ErrorKind::usage, fmt::format("--loop {} without a window needs an end: --count N", loop),
                 "afterglow play"};
  if (!headless && (count > 0 || fast || real_time || !screenshot.empty()))
    return Error{ErrorKind::usage, "--count, --fast, --real-time and --screenshot go with --headless",
                 "afterglow play"};
  for (const auto& [given, name] : {std::pair(full_screen, "--full-screen"),
                                    {!geometry.empty(), "--geometry"},
                                    {paused, "--paused"},
                                    {ui_scale.has_value(), "--ui-scale"},
                                    {!exports.empty(), "--export"}})
    if (headless && given)
      return Error{ErrorKind::usage, "is of the window, and --headless has none", name, 0,
                   "--screenshot FILE for a frame, `afterglow run` for more"};
  if (headless && shown_on.any())
    return Error{ErrorKind::usage, "--view-ocio and --view-icc are of the window: what is written stays without them",
                 "afterglow play"};
  std::error_code none;
  const bool checked_later =
      std::filesystem::is_directory(exports, none) || is_one_output(exports) || !new_folder(exports).empty();
  if (!exports.empty() && !checked_later) AFTERGLOW_CHECK(check_output(exports, {}));
  // The format goes by the extension: wrong ones are refused before any work.
  return screenshot.empty() ? Result<void>{} : check_output(screenshot, {});
}

Result<PlayerOptions> PlayArguments::player() const {
  PlayerOptions out;
  AFTERGLOW_TRY(out.live.stack, execution.options());
  AFTERGLOW_TRY(out.live.stack.preset, preset.options());
  AFTERGLOW_TRY(out.preset, preset.preset_file());
  if (!other.empty()) {
    AFTERGLOW_TRY(out.other_preset, named_preset(other, preset.paths));
    std::error_code none;
    if (!std::filesystem::exists(out.other_preset, none)) {
      Error error = missing_file(out.other_preset);
      error.kind = ErrorKind::script;
      error.allowed = "a preset for --b";
      return error;
    }
  }
  out.live.watch.poll = poll;
  out.footage.inputs = inputs;
  out.footage.frames = frames;
  if (!cuts.empty()) {
    AFTERGLOW_TRY(out.footage.cuts, parse_cuts(cuts));
  }
  AFTERGLOW_TRY(out.footage.proxy, parse_proxy(proxy));
  layers.choose_reading(out.footage.read);
  out.footage.read.mattes = layers.mattes;
  if (!layers.input_space.empty()) AFTERGLOW_CHECK(find_input_space(layers.input_space));
  out.footage.read.input_space = layers.input_space;
  out.footage.read.max_bytes = out.live.stack.max_memory;
  layers.choose(out.footage.read);
  auto memory = parse_memory(cache);
  if (!memory) {
    Error error = std::move(memory).error();
    error.file = "--cache";
    return error;
  }
  out.read_ahead = {memory.value(), readers};
  out.fps = fps;
  if (!headless) out.sound = SoundOptions{.mute = mute, .volume = volume / 100, .open_device = {}};
  if (!loop.empty()) {
    AFTERGLOW_TRY(out.loop, parse_loop_mode(loop));
  }
  AFTERGLOW_CHECK(check());
  out.show = show;
  return out;
}

Result<void> PlayArguments::check_shown(Player& player) const {
  if (show.empty()) return {};
  const std::vector<std::string> images = player.live().images();
  if (images.empty() || std::ranges::find(images, show) != images.end()) return {};
  return Error{ErrorKind::usage,          fmt::format("there is no image '{}'", show), "--show", 0, join(images),
               nearest_name(show, images)};
}

}  // namespace afterglow
