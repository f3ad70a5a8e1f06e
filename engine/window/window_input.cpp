// SPDX-License-Identifier: MIT
// What comes to a window that plays: keys and text, dropped files, the wish to close it.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "window/window_app.h"

namespace afterglow {

namespace {

constexpr int kFramesToField = 6;  // that a field may need to get the keyboard

/// While the keyboard is at a part of the interface, what has a letter, an arrow, Space, Enter or Tab is for that.
bool acts_everywhere(const InputEvent& key) {
  const bool function = key.code >= GLFW_KEY_F1 && key.code <= GLFW_KEY_F25;
  const bool letter = key.code >= GLFW_KEY_0 && key.code <= GLFW_KEY_Z;
  return function || key.code == GLFW_KEY_MENU || (letter && (key.mods & GLFW_MOD_CONTROL) != 0);
}

bool is_preset(const std::filesystem::path& path) { return path.extension() == ".lua" || path.extension() == ".zip"; }

}  // namespace

void WindowApp::take_events() {
  const WindowEvents events = window_.take_events();
  if (events.any) redraw_ = kSettle;
  if (events.exposed) painter_->expose();
  if (events.close) ask_to_quit();
  for (const InputEvent& event : events.input) input_.push(event);
  deliver_input();
  std::vector<std::filesystem::path> pictures;
  for (const auto& path : events.dropped) {
    if (is_preset(path)) {
      ask_to_quit(path);
    } else {
      pictures.push_back(path);
    }
  }
  if (!pictures.empty()) open_footage(pictures);
  for (const auto& path : std::exchange(to_open_, {})) open_preset(path);
  for (const auto& path : std::exchange(others_to_open_, {})) open_other(path);
}

/// As much as the next frame can tell apart. Keys act at once where no text is typed.
void WindowApp::deliver_input() {
  while (!field_awaited_) {
    const bool typing = interface_->wants_keyboard(), away = interface_->ui().pane != Pane::picture;
    const auto event = input_.next(typing || away);
    if (!event) break;
    const bool key = event->kind == InputEvent::Kind::key && event->down;
    if (event->kind == InputEvent::Kind::button && event->down) go_to_pane(Pane::picture);
    if (key && quitting_ == Quitting::asked) {
      if (const auto answer = quit_answer_of(event->code)) answer_quit(*answer);
      continue;
    }
    if (key && away && event->code == GLFW_KEY_ESCAPE && !interface_->holds_something() &&
        !interface_->ui().show_help) {
      go_to_pane(Pane::picture);
      continue;
    }
    const bool shortcut = key && !typing && (!away || acts_everywhere(*event));
    const auto action = shortcut ? action_of({event->code, event->mods, event->repeat}) : std::nullopt;
    if (action) act(*action);
    // An action is all that its key does: Tab would choose a field too, which takes the keys that follow. Esc closes
    // what ImGui opened.
    if (!action || *action == Action::escape) interface_->feed(*event);
    // Enter opens a field where the chosen item has one.
    if (key && away && !typing && (event->code == GLFW_KEY_ENTER || event->code == GLFW_KEY_KP_ENTER)) await_field();
  }
  if (field_awaited_ || !input_.empty()) redraw_ = std::max(redraw_, 1);
}

/// What is typed from here on is for the field that is about to get the keyboard.
void WindowApp::await_field() { field_awaited_ = kFramesToField; }

/// The next one that is shown; behind the last one the picture.
void WindowApp::go_to_next_pane() {
  const Ui& ui = interface_->ui();
  for (int next = static_cast<int>(ui.pane) + 1; next <= static_cast<int>(Pane::strip); ++next)
    if (window_of(static_cast<Pane>(next))[0] != '\0') return go_to_pane(static_cast<Pane>(next));
  go_to_pane(Pane::picture);
}

void WindowApp::go_to_pane(Pane pane) {
  Ui& ui = interface_->ui();
  if (ui.pane == pane) return;
  ui.pane = pane;
  pane_due_ = true;
  if (pane == Pane::picture) return ui.say("the keyboard is at the picture");
  ui.say(fmt::format("the keyboard is at {}: arrows, Space, Enter; F6 goes on, Esc goes back",
                     pane == Pane::panel ? "the panel"
                     : pane == Pane::bar ? "the bar"
                                         : "the export"));
}

/// By ImGui's name; empty: it is not shown, or there is none.
const char* WindowApp::window_of(Pane pane) const {
  const Ui& ui = interface_->ui();
  switch (pane) {
    case Pane::panel:
      return options_.panel && ui.show_panel ? "Settings" : "";
    case Pane::bar:
      return options_.transport && ui.show_transport ? "Transport" : "";
    case Pane::strip:
      return options_.strip_height && options_.strip_height(ui, 0) > 0 ? "Export" : "";
    case Pane::picture:
      break;
  }
  return "";
}

/// Within a frame, before its parts. One that went away has no keyboard.
void WindowApp::follow_pane() {
  Ui& ui = interface_->ui();
  if (ui.pane != Pane::picture && window_of(ui.pane)[0] == '\0') go_to_pane(Pane::picture);
  if (std::exchange(pane_due_, false)) {
    interface_->navigate(window_of(ui.pane));
    redraw_ = kSettle;
  }
}

/// What is not in the preset's file, and not yet exported, is asked about first.
void WindowApp::ask_to_quit(const std::filesystem::path& to_open_then) {
  redraw_ = kSettle;
  if (quitting_ != Quitting::no && quitting_ != Quitting::exporting) return;
  quitting_ = Quitting::no;  // what was asked for last counts
  to_open_then_ = to_open_then;
  if (options_.saving && options_.saving() == WindowOptions::Saving::busy) {
    quitting_ = Quitting::waiting;  // what is being written is no loss
    return window_.restore();       // minimised, nothing goes on
  }
  if (!quit_question().asks()) return leave();
  quitting_ = Quitting::asked;
  window_.restore();  // a question that nobody sees
  diagnostics_.note("asked whether to save");
}

/// An export goes on beside another preset.
QuitQuestion WindowApp::quit_question() const {
  const bool closes = to_open_then_.empty();
  QuitQuestion out{.before = closes ? "closing" : "opening " + to_open_then_.filename().string()};
  if (options_.unsaved) out.changes = options_.unsaved(player_);
  if (closes && options_.exporting && options_.exporting() == WindowOptions::Saving::busy)
    out.exporting = options_.export_state();
  return out;
}

/// Nothing holds the window back from what it was asked for.
void WindowApp::leave() {
  if (to_open_then_.empty()) {
    quit_ = true;
  } else {
    to_open_.push_back(std::exchange(to_open_then_, {}));  // with the next turn: see create
  }
}

void WindowApp::answer_quit(QuitAnswer answer) {
  redraw_ = kSettle;
  quitting_ = Quitting::no;
  if (answer == QuitAnswer::discard) leave();
  if (answer != QuitAnswer::save) return;
  const QuitQuestion question = quit_question();
  finishes_ = !question.exporting.empty();
  if (question.changes.empty()) return await_export();
  if (!options_.save) return;
  if (options_.save(player_, interface_->ui())) await_field();
  quitting_ = Quitting::saving;
}

/// What was to be finished may have failed while the preset was saved.
void WindowApp::await_export() {
  const QuitQuestion question = quit_question();
  const bool failed = finishes_ && options_.exporting() == WindowOptions::Saving::failed;
  if (question.exporting.empty()) return failed ? void() : leave();
  quitting_ = Quitting::exporting;
  left_ = question.changes;
  interface_->ui().say("closes when the export has ended");
}

/// A save that fails, or leaves something out, keeps the preset open: it says why. So does an export that fails. What
/// changed since one that was under way began is asked about.
void WindowApp::quit_when_saved() {
  using Saving = WindowOptions::Saving;
  if (quitting_ == Quitting::no || quitting_ == Quitting::asked) return;
  const auto& asked = quitting_ == Quitting::exporting ? options_.exporting : options_.saving;
  const Saving state = asked ? asked() : Saving::done;
  redraw_ = std::max(redraw_, 1);
  if (state == Saving::busy) return;
  const Quitting was = std::exchange(quitting_, Quitting::no);
  if (state != Saving::done) return;
  if (was == Quitting::waiting) return ask_to_quit(std::exchange(to_open_then_, {}));
  if (was == Quitting::saving) return await_export();
  if (quit_question().changes == left_) return leave();
  ask_to_quit();
}

/// Within a frame. An export that ends while it is asked about need not be asked about.
void WindowApp::ask_about_quitting() {
  if (quitting_ != Quitting::asked) return;
  const QuitQuestion question = quit_question();
  if (question.asks()) {
    if (const auto answer = draw_quit_dialog(interface_->ui(), question, ImGui::GetIO().DisplaySize))
      answer_quit(*answer);
    return;
  }
  quitting_ = Quitting::no;
  redraw_ = kSettle;
  const bool failed = options_.exporting && options_.exporting() == WindowOptions::Saving::failed;
  if (!failed) leave();
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

/// In the preset's place.
void WindowApp::open_preset(const std::filesystem::path& path) {
  (void)painter_->finish();  // see open_footage
  const Result<void> opened = player_.open_preset(path);
  if (opened && options_.preset_opened) options_.preset_opened(path);
  tell_opened(opened, {path});
}

/// In the footage's place, one after the other.
void WindowApp::open_footage(const std::vector<std::filesystem::path>& paths) {
  // What is closed for it may still be on its way to the screen. A lost device shows up in the next turn.
  (void)painter_->finish();
  std::vector<std::string> inputs;
  for (const auto& path : paths) inputs.push_back(path.string());
  tell_opened(player_.open_footage(inputs), paths);
}

void WindowApp::tell_opened(const Result<void>& opened, const std::vector<std::filesystem::path>& paths) {
  const std::string more = paths.size() > 1 ? fmt::format(" and {} more", paths.size() - 1) : "";
  const auto& path = paths.front();
  interface_->ui().say(opened ? fmt::format("opened {}{}", path.filename().string(), more) : opened.error().text());
  diagnostics_.note(opened ? fmt::format("opened {}{}", path.string(), more) : opened.error().text());
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
  (void)painter_->finish();  // see open_footage
  const Result<void> opened = player_.open_other(path);
  if (opened) player_.view().compare = Compare::other;
  interface_->ui().say(opened ? fmt::format("opened {} as B", path.filename().string()) : opened.error().text());
  diagnostics_.note(opened ? fmt::format("opened {} as B", path.string()) : opened.error().text());
  redraw_ = kSettle;
}

}  // namespace afterglow
