// SPDX-License-Identifier: MIT
// What comes to a window that plays: keys and text, dropped files, the wish to close it.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "window/window_app.h"

namespace afterglow {

namespace {

constexpr int kFramesToField = 6;  // that a field may need to get the keyboard

}  // namespace

void WindowApp::take_events() {
  const WindowEvents events = window_.take_events();
  if (events.any) redraw_ = kSettle;
  if (events.close) ask_to_quit();
  for (const InputEvent& event : events.input) input_.push(event);
  deliver_input();
  for (const auto& path : events.dropped) open_dropped(path);
  for (const auto& path : std::exchange(to_open_, {})) open_dropped(path);
  for (const auto& path : std::exchange(others_to_open_, {})) open_other(path);
}

/// As much as the next frame can tell apart. Keys act at once where no text is typed.
void WindowApp::deliver_input() {
  while (!field_awaited_) {
    const bool typing = interface_->wants_keyboard();
    const auto event = input_.next(typing);
    if (!event) break;
    const bool key = event->kind == InputEvent::Kind::key && event->down;
    if (key && quitting_ == Quitting::asked) {
      if (const auto answer = quit_answer_of(event->code)) answer_quit(*answer);
      continue;
    }
    const auto action = key && !typing ? action_of({event->code, event->mods, event->repeat}) : std::nullopt;
    if (action) act(*action);
    // An action is all that its key does: Tab would choose a field too, which takes the keys that follow. Esc closes
    // what ImGui opened.
    if (!action || *action == Action::escape) interface_->feed(*event);
  }
  if (field_awaited_ || !input_.empty()) redraw_ = std::max(redraw_, 1);
}

/// What is typed from here on is for the field that is about to get the keyboard.
void WindowApp::await_field() { field_awaited_ = kFramesToField; }

/// What is not in the preset's file is asked about first.
void WindowApp::ask_to_quit() {
  redraw_ = kSettle;
  if (quitting_ != Quitting::no) return;
  if (options_.saving && options_.saving() == WindowOptions::Saving::busy) {
    quitting_ = Quitting::saving;  // what is being written is no loss
    return;
  }
  const bool unsaved = options_.unsaved && !options_.unsaved(player_).empty();
  quitting_ = unsaved ? Quitting::asked : Quitting::no;
  if (unsaved) diagnostics_.note("asked whether to save");
  quit_ = quit_ || !unsaved;
}

void WindowApp::answer_quit(QuitAnswer answer) {
  redraw_ = kSettle;
  quitting_ = Quitting::no;
  if (answer == QuitAnswer::discard) quit_ = true;
  if (answer != QuitAnswer::save || !options_.save) return;
  options_.save(player_, interface_->ui());
  quitting_ = Quitting::saving;
}

/// A save that fails, or leaves something out, keeps the window open: it says why.
void WindowApp::quit_when_saved() {
  if (quitting_ != Quitting::saving) return;
  const auto state = options_.saving ? options_.saving() : WindowOptions::Saving::done;
  redraw_ = std::max(redraw_, 1);
  if (state == WindowOptions::Saving::busy) return;
  quitting_ = Quitting::no;
  quit_ = state == WindowOptions::Saving::done;
}

/// The frame has seen what it was given. A field that gets the keyboard has it within a few frames: what is typed
/// meanwhile is the field's.
void WindowApp::input_seen() {
  input_.frame_done();
  if (std::exchange(interface_->ui().field_opens, false)) {
    await_field();
    return;
  }
  if (field_awaited_ == 0 && interface_->ui().typed.opening()) await_field();
  if (field_awaited_ > 0) field_awaited_ = interface_->wants_keyboard() ? 0 : field_awaited_ - 1;
  deliver_input();
}

/// A preset takes the preset's place, anything else the footage's.
void WindowApp::open_dropped(const std::filesystem::path& path) {
  Ui& ui = interface_->ui();
  const auto extension = path.extension();
  const bool preset = extension == ".lua" || extension == ".zip";
  // What is closed for it may still be on its way to the screen. A lost device shows up in the next turn.
  (void)painter_->finish();
  const Result<void> opened = preset ? player_.open_preset(path) : player_.open_footage({path.string()});
  if (opened && preset && options_.preset_opened) options_.preset_opened(path);
  ui.say(opened ? fmt::format("opened {}", path.filename().string()) : opened.error().text());
  diagnostics_.note(opened ? fmt::format("opened {}", path.string()) : opened.error().text());
  redraw_ = kSettle;
}

void WindowApp::browse_presets() {
  redraw_ = kSettle;
  if (!options_.browse_presets) return;
  options_.browse_presets(player_, interface_->ui());
  await_field();
}

/// A preset becomes B, and is seen beside the first.
void WindowApp::open_other(const std::filesystem::path& path) {
  (void)painter_->finish();  // see open_dropped
  const Result<void> opened = player_.open_other(path);
  if (opened) player_.view().compare = Compare::other;
  interface_->ui().say(opened ? fmt::format("opened {} as B", path.filename().string()) : opened.error().text());
  diagnostics_.note(opened ? fmt::format("opened {} as B", path.string()) : opened.error().text());
  redraw_ = kSettle;
}

}  // namespace afterglow
