// SPDX-License-Identifier: MIT
#include "window/window_app.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <limits>

namespace afterglow {

namespace {

constexpr double kLeastPause = 1.0 / 120;  // between frames that show no new picture
constexpr double kBlink = 0.5;
constexpr double kLongest = 0.25;  // a signal wakes nobody: look for one this often

}  // namespace

Result<void> run_window(DesktopWindow& window, Device& device, Player& player, const WindowOptions& options,
                        Diagnostics& diagnostics) {
  AFTERGLOW_TRY(const auto app, WindowApp::create(window, device, player, options, diagnostics));
  return app->run();
}

Result<std::unique_ptr<WindowApp>> WindowApp::create(DesktopWindow& window, Device& device, Player& player,
                                                     const WindowOptions& options, Diagnostics& diagnostics) {
  std::unique_ptr<WindowApp> app(new WindowApp(window, player, options, diagnostics));
  app->interface_ = std::make_unique<Interface>(window.handle());
  app->interface_->set_scale(options.scale.value_or(window.content_scale()));
  AFTERGLOW_TRY(app->painter_, Painter::create(device, {.tearing = options.tearing, .readback = true}, options.check));
  Ui& ui = app->interface_->ui();
  ui.show_stats = options.stats;
  if (options.display) {
    AFTERGLOW_CHECK(app->show_display(*options.display));
    if (options.make_display)
      app->displays_ = std::make_unique<DisplayKeeper>(*options.display, options.make_display, &DesktopWindow::wake);
    ui.choose_display = [raw = app.get()](const std::string& display, const std::string& view) {
      if (raw->displays_) raw->displays_->choose(display, view);
    };
  }
  ui.copy = [&window](const std::string& text) { window.set_clipboard(text); };
  // Not within the frame that asks for it: what asks may be gone then.
  ui.open = [raw = app.get()](const std::string& path) { raw->to_open_.emplace_back(path); };
  ui.open_other = [raw = app.get()](const std::string& path) { raw->others_to_open_.emplace_back(path); };
  ui.browse_presets = [raw = app.get()] { raw->browse_presets(); };
  ui.edit_file = [raw = app.get()](const std::string& file, int line) { raw->edit_file(file, line); };
  ui.again = [raw = app.get()] { raw->redraw_ = std::max(raw->redraw_, 2); };
  return app;
}

Result<void> WindowApp::run() {
  window_.show();
  if (options_.full_screen) window_.set_full_screen(true);
  while (!quit_) {
    AFTERGLOW_TRY(const Step turn, step());
    note_step(turn);
    AFTERGLOW_CHECK(follow_display());
    if (!minimised_ && (redraw_ > 0 || !step_shown_)) AFTERGLOW_CHECK(draw());
    if (minimised_ && quitting_ == Quitting::exporting && options_.hidden_panel) {
      options_.hidden_panel(player_, interface_->ui());  // it looks after the export
      quit_when_saved();
    }
    wait(turn);
    take_events();
    quit_ = quit_ || options_.interrupted();
  }
  window_.hide();  // what is being read may take a while to end
  diagnostics_.note(fmt::format("window closed: {} frames drawn", painter_->swapchain().counters().presented));
  return {};
}

Result<void> WindowApp::show_display(const ShownDisplay& shown) {
  const DisplayTable& table = shown.table;
  AFTERGLOW_CHECK(painter_->take_display(table));
  Ui& ui = interface_->ui();
  ui.display = table.name;
  ui.display_name = shown.display;
  ui.display_view = shown.view;
  ui.displays = shown.choices;
  diagnostics_.note(fmt::format("view: {}, within {:.1f} codes of 8 bits (mean {:.2f})", table.name,
                                table.largest_error, table.mean_error));
  redraw_ = kSettle;
  return {};
}

/// The display's files have changed, or another one was chosen.
Result<void> WindowApp::follow_display() {
  const auto made = displays_ ? displays_->take() : std::nullopt;
  if (!made) return {};
  if (*made) {
    player_.view().as_display = true;
    interface_->ui().say("view: " + (*made)->table.name);
    return show_display(**made);
  }
  diagnostics_.warn("the view stays as it was: " + made->error().text());
  interface_->ui().say("the view stays as it was: " + made->error().text());
  redraw_ = kSettle;
  return {};
}

Result<Step> WindowApp::step() {
  minimise_or_restore(window_.extent().framebuffer.area() == 0);
  if (minimised_) return Step{.next = std::numeric_limits<double>::infinity()};
  // The player may write what the last frame reads.
  AFTERGLOW_CHECK(painter_->finish());
  AFTERGLOW_TRY(const Step turn, player_.step());
  tell_failure();
  if (turn.changed) {
    ++turn_;
    step_shown_ = false;
    redraw_ = std::max(redraw_, 1);
  }
  if (turn.timed && player_.session().all_timed()) redraw_ = std::max(redraw_, 1);
  if (turn.told) redraw_ = kSettle;
  return turn;
}

/// Why the picture stays, for the terminal too: once, until another reason comes or there is none.
void WindowApp::tell_failure() {
  const auto& failed = player_.shown().failed;
  const std::string text = failed ? failed->text() : "";
  if (text == told_failure_) return;
  told_failure_ = text;
  if (failed) diagnostics_.warn("the stack cannot be run: " + text);
}

/// A hidden window plays nothing, and drops nothing either.
void WindowApp::minimise_or_restore(bool minimised) {
  if (minimised == minimised_) return;
  minimised_ = minimised;
  Transport& transport = player_.transport();
  if (minimised) {
    resume_ = transport.playing();
    transport.pause(player_.now());
  } else {
    if (resume_) transport.play(player_.now());
    redraw_ = kSettle;
  }
}

/// Windows of other sizes leave holes of all sizes in the heap where drivers on the CPU have their images.
void WindowApp::tidy() {
  const Swapchain::Counters counters = painter_->swapchain().counters();
  if (counters.made == tidied_ || counters.retired > 0) return;
  tidied_ = counters.made;
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

void WindowApp::wait(const Step& turn) {
  const double now = player_.now();
  double until = turn.next;
  if (minimised_) {
    until = std::numeric_limits<double>::infinity();
  } else if (redraw_ > 0 || !step_shown_) {
    until = std::min(until, last_draw_ + kLeastPause);
  } else {
    tidy();
    const Ui& ui = interface_->ui();
    if (ui.message_until > now) until = std::min(until, ui.message_until);
    until = std::min(until, ui.hover.wake());
    if (interface_->wants_keyboard()) until = std::min(until, now + kBlink);
    if (scopes_due()) until = std::min(until, scopes_.when + kScopesPause);
  }
  window_.wait(std::clamp(until - now, 0.0, kLongest));
  const double later = player_.now();
  const Ui& ui = interface_->ui();
  const bool faded = !ui.message.empty() && ui.message_until <= later;
  const bool rested = ui.hover.wake() <= later;
  if (faded || interface_->wants_keyboard() || scopes_due()) redraw_ = std::max(redraw_, 1);
  if (rested) redraw_ = kSettle;  // a tip finds its size in its first frame, and is seen from the second on
}

/// What scripts and tests that watch us want to know.
void WindowApp::note_step(const Step& turn) {
  if (options_.news && options_.news()) redraw_ = std::max(redraw_, 2);  // the atlas, then what is drawn of it
  if (turn.reloaded || turn.changed) redraw_ = std::max(redraw_, 1);
  const LiveStatus status = player_.live().status();
  const std::string error = status.error ? status.error->text() : "";
  if (status.generation != noted_generation_) {
    noted_generation_ = status.generation;
    diagnostics_.note(fmt::format("reload {}: taken", status.generation));
    redraw_ = kSettle;
  }
  if (error != noted_error_) {
    noted_error_ = error;
    diagnostics_.note(error.empty() ? "reload: good again" : "reload: failed");
    if (!error.empty() && !player_.live().stack()) diagnostics_.warn("no good version yet: " + status.error_text());
    redraw_ = kSettle;
  }
  update_title();
}

void WindowApp::update_title() {
  const ShownFrame& shown = player_.shown();
  Stack* stack = player_.live().stack();
  const std::string preset = stack ? stack->preset().name() : "no preset yet";
  std::string title = shown.name.empty() ? preset : fmt::format("{} – {}", shown.name, preset);
  if (!noted_error_.empty()) title += " (error)";
  title += " – Afterglow";
  if (title == title_) return;
  title_ = title;
  window_.set_title(title);
}

}  // namespace afterglow
