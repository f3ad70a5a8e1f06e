// SPDX-License-Identifier: MIT
// What keys do to the transport, the preset and the window.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/file.h"
#include "window/editor.h"
#include "window/help_sheet.h"
#include "window/window_app.h"

namespace afterglow {

namespace {

/// A name that is free, by date and time.
std::filesystem::path capture_name(const std::filesystem::path& folder) {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm local{};
  localtime_r(&now, &local);
  char stamp[32];
  std::strftime(stamp, sizeof stamp, "%Y%m%d-%H%M%S", &local);
  std::error_code ec;
  for (int i = 0;; ++i) {
    const auto file = folder / fmt::format("afterglow-{}{}.png", stamp, i == 0 ? "" : fmt::format("-{}", i));
    if (!std::filesystem::exists(file, ec)) return file;
  }
}

}  // namespace

void WindowApp::act(Action action) {
  redraw_ = kSettle;
  (void)(act_on_transport(action) || act_on_view(action) || act_on_picture(action) || act_on_preset(action) ||
         act_on_window(action));
}

bool WindowApp::act_on_transport(Action action) {
  Transport& t = player_.transport();
  const double now = player_.now();
  Ui& ui = interface_->ui();
  const auto faster = [&](double factor) {
    const double speed = t.speed() * factor;
    // Halves and doubles of 1, which they come back to.
    if (std::abs(speed) >= Transport::kSlowest && std::abs(speed) <= Transport::kFastest) t.set_speed(speed, now);
    ui.say(fmt::format("speed {:g}×", t.speed()));
  };
  switch (action) {
    case Action::play:
      t.toggle(now);
      return true;
    case Action::shuttle_back:
      shuttle(-1);
      return true;
    case Action::shuttle_pause:
      t.pause(now);
      t.set_speed(1, now);
      return true;
    case Action::shuttle_forward:
      shuttle(1);
      return true;
    case Action::go_to_frame:
      ui.show_frame_field = ui.frame_field.begin = true;
      ui.frame_field.text.fill(0);
      await_field();
      return true;
    case Action::mark:
    case Action::name_mark:
    case Action::next_mark:
    case Action::previous_mark:
      if (options_.marks && options_.marks(player_, ui, action)) await_field();
      return true;
    case Action::next_clip:
      go_to_clip(1);
      return true;
    case Action::previous_clip:
      go_to_clip(-1);
      return true;
    case Action::step_forward:
      t.step(1, now);
      return true;
    case Action::step_back:
      t.step(-1, now);
      return true;
    case Action::jump_forward:
      t.step(10, now);
      return true;
    case Action::jump_back:
      t.step(-10, now);
      return true;
    case Action::go_to_first:
      t.go_to_first(now);
      return true;
    case Action::go_to_last:
      t.go_to_last(now);
      return true;
    case Action::loop_mode:
      t.set_loop(static_cast<LoopMode>((static_cast<int>(t.loop()) + 1) % 3), now);
      ui.say(loop_mode_name(t.loop()));
      return true;
    case Action::range_begin:
      t.set_range(t.position(), std::max(t.last(), t.position()), now);
      return true;
    case Action::range_end:
      t.set_range(std::min(t.first(), t.position()), t.position(), now);
      return true;
    case Action::range_clear:
      t.clear_range(now);
      return true;
    case Action::sound:
    case Action::louder:
    case Action::quieter:
      change_sound(action);
      return true;
    case Action::slower:
      faster(0.5);
      return true;
    case Action::faster:
      faster(2);
      return true;
    default:
      return false;
  }
}

/// Backwards it stops at the first frame of the clip that is shown.
void WindowApp::go_to_clip(int by) {
  Transport& t = player_.transport();
  const auto& clips = player_.footage().clips();
  const int here = player_.footage().clip_at(t.position());
  const bool to_begin = by < 0 && t.position() > clips[static_cast<std::size_t>(here)].first;
  const int there = std::clamp(to_begin ? here : here + by, 0, static_cast<int>(clips.size()) - 1);
  if (by > 0 && there == here)
    return interface_->ui().say(clips.size() > 1 ? "this is the last clip" : "there is one clip");
  const auto& clip = clips[static_cast<std::size_t>(there)];
  t.go_to(clip.first, player_.now());
  interface_->ui().say(fmt::format("clip {} of {}: {}", there + 1, clips.size(), clip.label));
}

void WindowApp::change_sound(Action action) {
  Sound* sound = player_.sound();
  Ui& ui = interface_->ui();
  if (!sound) return ui.say("there is no sound");
  if (const std::string why = sound->failure(); !why.empty()) return ui.say(why);
  constexpr double kStep = 0.1;
  if (action == Action::sound) {
    sound->set_mute(!sound->mute());
  } else {
    sound->set_volume(std::round((sound->volume() + (action == Action::louder ? kStep : -kStep)) / kStep) * kStep);
    sound->set_mute(false);
  }
  ui.say(sound->mute() ? "silent: U lets it be heard" : fmt::format("sound {:.0f} %", sound->volume() * 100));
}

/// The sheet of keys, where screenshots go.
void WindowApp::print_keys() {
  const auto file = options_.captures / "afterglow-keys.html";
  const auto written = write_file_atomically(file, keys_page());
  interface_->ui().say(written ? "written, to print from a browser: " + file.string() : written.error().text());
  diagnostics_.note(written ? "keys written to " + file.string() : written.error().text());
}

/// One way at the speed of the clock; pressed again, twice as fast.
void WindowApp::shuttle(int direction) {
  Transport& t = player_.transport();
  const double now = player_.now();
  const bool goes_on = t.playing() && (t.speed() < 0) == (direction < 0);
  t.set_speed(goes_on ? t.speed() * 2 : direction, now);
  t.play(now);
  interface_->ui().say(fmt::format("speed {:g}×", t.speed()));
}

void WindowApp::edit_file(const std::string& file, int line) {
  const auto opened = open_in_editor(file, line);
  interface_->ui().say(opened ? fmt::format("{}:{} goes to the editor", file, std::max(line, 1))
                              : opened.error().text());
}

/// The first error; while the message stays, each time the next one.
void WindowApp::edit_next_place() {
  const std::string message = current_message(player_);
  if (message != edited_.message) edited_ = {message, 0};
  const auto places = current_places(player_);
  const ErrorPlace& place = places[edited_.next++ % places.size()];
  edit_file(place.file.string(), place.line);
}

void WindowApp::keep_snapshot(int snapshot) {
  player_.end_gesture();
  player_.keep_snapshot(snapshot);
  interface_->ui().say(fmt::format("kept as snapshot {0}; Ctrl+{0} brings it back", snapshot + 1));
}

void WindowApp::recall_snapshot(int snapshot) {
  Ui& ui = interface_->ui();
  player_.end_gesture();
  if (!player_.edits().has(snapshot))
    return ui.say(fmt::format("nothing was kept as snapshot {0}: Ctrl+Shift+{0} does", snapshot + 1));
  const bool changed = player_.recall_snapshot(snapshot);
  ui.say(fmt::format("snapshot {}{}", snapshot + 1, changed ? "" : ": it is so already"));
}

bool WindowApp::act_on_preset(Action action) {
  Ui& ui = interface_->ui();
  switch (action) {
    case Action::reload:
      player_.live().reload();
      if (LiveStack* other = player_.other()) other->reload();
      player_.reload_pictures();
      return true;
    case Action::proxy: {
      (void)painter_->finish();  // its pictures may be on their way to the screen
      const int now = player_.proxy();
      player_.set_proxy(now > 1 ? 1 : proxy_);
      if (now > 1) proxy_ = now;
      ui.say(now > 1 ? "whole pictures" : "proxy " + proxy_name(player_.proxy()) + ": Shift+P shows whole pictures");
      return true;
    }
    case Action::edit_file: {
      edit_next_place();
      return true;
    }
    case Action::copy_message: {
      const std::string text = current_message(player_);
      if (!text.empty()) {
        ui.copy(text);
        ui.say("message copied");
      }
      return true;
    }
    case Action::undo:
      ui.say(player_.undo() ? "undone" : "nothing to undo");
      return true;
    case Action::redo:
      ui.say(player_.redo() ? "done again" : "nothing to do again");
      return true;
    case Action::keep_1:
    case Action::keep_2:
    case Action::keep_3:
      keep_snapshot(static_cast<int>(action) - static_cast<int>(Action::keep_1));
      return true;
    case Action::recall_1:
    case Action::recall_2:
    case Action::recall_3:
      recall_snapshot(static_cast<int>(action) - static_cast<int>(Action::recall_1));
      return true;
    case Action::save:
      if (options_.save && options_.save(player_, ui)) await_field();
      return true;
    case Action::undo_save:
      if (options_.undo_save) options_.undo_save(player_, ui);
      return true;
    case Action::reset_all: {
      const bool edited = !player_.edits().none();
      player_.end_gesture();
      player_.reset_all();
      ui.say(edited ? "stack and settings as the file has them" : "nothing was changed");
      return true;
    }
    case Action::browse_presets:
      browse_presets();
      return true;
    case Action::save_as:
    case Action::add_effect:
    case Action::next_entry:
    case Action::previous_entry:
    case Action::entry_earlier:
    case Action::entry_later:
    case Action::duplicate_entry:
    case Action::remove_entry:
    case Action::toggle_entry:
    case Action::copy_settings:
    case Action::paste_settings:
      if (!options_.edit_stack) return true;
      ui.show_panel = true;
      if (options_.edit_stack(player_, ui, action)) await_field();
      return true;
    case Action::search:
      ui.show_panel = true;
      if (options_.search) {
        options_.search(player_, ui);
        await_field();
      }
      return true;
    default:
      return false;
  }
}

bool WindowApp::act_on_window(Action action) {
  Ui& ui = interface_->ui();
  switch (action) {
    case Action::panel:
      ui.show_panel = !ui.show_panel;
      return true;
    case Action::transport:
      ui.show_transport = !ui.show_transport;
      return true;
    case Action::next_pane:
      go_to_next_pane();
      return true;
    case Action::item_menu:
      ui.item_menu = true;
      return true;
    case Action::print_keys:
      print_keys();
      return true;
    case Action::stats:
      ui.show_stats = !ui.show_stats;
      return true;
    case Action::full_screen:
      window_.set_full_screen(!window_.full_screen());
      return true;
    case Action::screenshot:
      painter_->capture(capture_name(options_.captures));
      return true;
    case Action::export_frame:
      if (player_.proxy() > 1) (void)painter_->finish();  // the whole picture runs in its place
      if (options_.export_frame) options_.export_frame(player_, ui);
      return true;
    case Action::export_range:
      if (!options_.export_range) return true;
      options_.export_range(player_, ui);
      await_field();
      return true;
    case Action::help:
      ui.show_help = !ui.show_help;
      return true;
    case Action::escape:
      if (interface_->close_popups()) return true;
      if (ui.show_help) {
        ui.show_help = false;
      } else if (!options_.close_windows || !options_.close_windows()) {
        window_.set_full_screen(false);
      }
      return true;
    case Action::quit:
      ask_to_quit();
      return true;
    default:
      return false;
  }
}

}  // namespace afterglow
