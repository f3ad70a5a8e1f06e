// SPDX-License-Identifier: MIT
#include "window/window_app.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "window/frame_field.h"

namespace afterglow {

namespace {

constexpr float kPanelWidth = 376, kTransportHeight = 78;
constexpr int kFramesToField = 6;          // that a field may need to get the keyboard
constexpr int kSettle = 3;                 // ImGui needs a frame to see an event and one to answer it
constexpr double kLeastPause = 1.0 / 120;  // between frames that show no new picture
constexpr double kBlink = 0.5, kHistogramPause = 0.1;
constexpr double kLongest = 0.25;  // a signal wakes nobody: look for one this often
constexpr double kRetry = 0.02;    // when the window could not be drawn to

ViewImage view_image(const DeviceImage& image) { return {image.binding.view, image.layout, image.binding.size}; }

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
  AFTERGLOW_TRY(app->painter_, Painter::create(device, {.tearing = options.tearing, .readback = true}));
  Ui& ui = app->interface_->ui();
  ui.show_stats = options.stats;
  ui.copy = [&window](const std::string& text) { window.set_clipboard(text); };
  // Not within the frame that asks for it: what asks may be gone then.
  ui.open = [raw = app.get()](const std::string& path) { raw->to_open_.emplace_back(path); };
  ui.again = [raw = app.get()] { raw->redraw_ = std::max(raw->redraw_, 2); };
  return app;
}

Result<void> WindowApp::run() {
  window_.show();
  if (options_.full_screen) window_.set_full_screen(true);
  while (!quit_) {
    AFTERGLOW_TRY(const Step turn, step());
    note_step(turn);
    if (!minimised_ && (redraw_ > 0 || !step_shown_)) AFTERGLOW_CHECK(draw());
    wait(turn);
    take_events();
    quit_ = quit_ || options_.interrupted();
  }
  diagnostics_.note(fmt::format("window closed: {} frames drawn", painter_->swapchain().counters().presented));
  return {};
}

Result<Step> WindowApp::step() {
  minimise_or_restore(window_.framebuffer().area() == 0);
  if (minimised_) return Step{.next = std::numeric_limits<double>::infinity()};
  // The player may write what the last frame reads.
  AFTERGLOW_CHECK(painter_->finish());
  AFTERGLOW_TRY(const Step turn, player_.step());
  if (turn.changed) {
    ++turn_;
    step_shown_ = false;
    redraw_ = std::max(redraw_, 1);
  }
  if (turn.timed && player_.session().all_timed()) redraw_ = std::max(redraw_, 1);
  return turn;
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

void WindowApp::wait(const Step& turn) {
  const double now = player_.now();
  double until = turn.next;
  if (minimised_) {
    until = std::numeric_limits<double>::infinity();
  } else if (redraw_ > 0 || !step_shown_) {
    until = std::min(until, last_draw_ + kLeastPause);
  } else {
    const Ui& ui = interface_->ui();
    if (ui.message_until > now) until = std::min(until, ui.message_until);
    until = std::min(until, ui.hover.wake());
    if (interface_->wants_keyboard()) until = std::min(until, now + kBlink);
    if (ui.show_histogram && spread_.turn != turn_) until = std::min(until, spread_.when + kHistogramPause);
  }
  window_.wait(std::clamp(until - now, 0.0, kLongest));
  const double later = player_.now();
  const Ui& ui = interface_->ui();
  const bool faded = !ui.message.empty() && ui.message_until <= later;
  const bool rested = ui.hover.wake() <= later;
  if (faded || rested || interface_->wants_keyboard() || (ui.show_histogram && spread_.turn != turn_)) {
    redraw_ = std::max(redraw_, 1);
  }
}

void WindowApp::take_events() {
  const WindowEvents events = window_.take_events();
  if (events.any) redraw_ = kSettle;
  if (events.close) ask_to_quit();
  for (const InputEvent& event : events.input) input_.push(event);
  deliver_input();
  for (const auto& path : events.dropped) open_dropped(path);
  for (const auto& path : std::exchange(to_open_, {})) open_dropped(path);
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
    interface_->feed(*event);
    if (!key || typing) continue;
    if (const auto action = action_of({event->code, event->mods, event->repeat})) act(*action);
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

/// What scripts and tests that watch us want to know.
void WindowApp::note_step(const Step& turn) {
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

Result<void> WindowApp::follow_scale() {
  if (interface_->set_scale(options_.scale.value_or(window_.content_scale()))) {
    AFTERGLOW_CHECK(painter_->take_fonts());
  }
  return {};
}

Result<void> WindowApp::draw() {
  AFTERGLOW_CHECK(follow_scale());
  const Size window = window_.framebuffer();
  if (window.area() == 0) return {};
  Ui& ui = interface_->ui();
  ui.now = player_.now();
  ui.hover.begin_frame();
  interface_->begin();
  draw_parts(window);
  navigate();
  AFTERGLOW_CHECK(draw_overlays());
  draw_frame_field();
  quit_when_saved();
  if (quitting_ == Quitting::asked) {
    const std::string changes = options_.unsaved(player_) + " would be lost.";
    if (const auto answer = draw_quit_dialog(ui, changes, ImGui::GetIO().DisplaySize)) answer_quit(*answer);
  }
  if (options_.help && ui.show_help) options_.help(player_, ui, {0, 0}, ImGui::GetIO().DisplaySize);
  const ImDrawData& data = interface_->end();
  AFTERGLOW_TRY(const auto drawn, painter_->paint(window, view_frames(), data));
  last_draw_ = player_.now();
  if (drawn == Swapchain::Drawn::yes && redraw_ > 0) --redraw_;
  input_seen();
  if (drawn != Swapchain::Drawn::yes) {
    last_draw_ += kRetry;
    return {};
  }
  if (!step_shown_) {
    step_shown_ = true;
    player_.presented();
    const ShownFrame& shown = player_.shown();
    const std::string name = shown.name.empty() ? "nothing" : shown.name;
    if (shown.unreadable) {
      diagnostics_.note(fmt::format("unreadable {}: position {}: {}", name, shown.position, shown.unreadable->text()));
    } else {
      diagnostics_.note(fmt::format("shown {}: position {}, generation {}, window {}x{}{}", name, shown.position,
                                    noted_generation_, window.width, window.height,
                                    shown.held ? fmt::format(", in place of frame {}", shown.number) : ""));
    }
  }
  return {};
}

/// The panel at the right, the transport at the bottom, the rest is the picture's.
void WindowApp::draw_parts(Size window) {
  Ui& ui = interface_->ui();
  const ImGuiIO& io = ImGui::GetIO();
  const float width = io.DisplaySize.x, height = io.DisplaySize.y;
  const float panel = options_.panel && ui.show_panel ? std::min(ui.px(kPanelWidth), width * 0.6f) : 0;
  const float wanted =
      options_.transport_height ? options_.transport_height(ui, width - panel) : ui.px(kTransportHeight);
  const float bar = options_.transport && ui.show_transport ? std::min(wanted, height * 0.5f) : 0;
  player_.time_kernels(panel > 0);  // it shows what effects cost
  if (panel > 0) {
    options_.panel(player_, ui, {width - panel, 0}, {panel, height});
  } else if (options_.hidden_panel) {
    options_.hidden_panel(player_, ui);
  }
  if (bar > 0) options_.transport(player_, ui, {0, height - bar}, {width - panel, bar});
  const float sx = io.DisplayFramebufferScale.x, sy = io.DisplayFramebufferScale.y;
  area_ = {0, 0, std::max(window.width - static_cast<int>(std::lround(panel * sx)), 1),
           std::max(window.height - static_cast<int>(std::lround(bar * sy)), 1)};
  ui.picture_window = picture_window();
}

std::vector<ViewFrame> WindowApp::view_frames() const {
  const PlayerImages images = player_.images();
  if (images.result.binding.view == VK_NULL_HANDLE) return {};
  ViewFrame frame;
  frame.shown = view_image(images.result);
  frame.view = player_.view();
  std::optional<ViewImage> compared;
  if (frame.view.compare == Compare::source && images.source.binding.view) compared = view_image(images.source);
  if (frame.view.compare == Compare::other && images.other) compared = view_image(*images.other);
  frame.picture = images.picture;
  frame.area = area_;
  frame.background = background_;
  frame.pixel_scale = interface_->ui().scale;
  if (!compared) return {frame};
  switch (frame.view.by) {
    case CompareBy::flip:
      frame.shown = *compared;
      return {frame};
    case CompareBy::side_by_side: {
      const Size half = picture_window();
      ViewFrame left = frame;
      left.shown = *compared;
      left.area = {area_.x, area_.y, half.width, half.height};
      frame.area = {area_.x + area_.width - half.width, area_.y, half.width, half.height};
      return {left, frame};
    }
    default:
      frame.compared = compared;
      return {frame};
  }
}

Result<void> WindowApp::draw_overlays() {
  AFTERGLOW_CHECK(look_under_cursor());
  AFTERGLOW_CHECK(look_at_histogram());
  const Ui& ui = interface_->ui();
  const OverlayArea area{ImVec2(0, 0),
                         ImVec2(static_cast<float>(area_.width) / ImGui::GetIO().DisplayFramebufferScale.x,
                                static_cast<float>(area_.height) / ImGui::GetIO().DisplayFramebufferScale.y)};
  const OverlayPicture place = overlay_picture();
  draw_frame_mark(player_, ui, place, area);
  if (under_cursor_.probe) draw_pixel_mark(under_cursor_.probe->pixel, ui, place);
  draw_state_overlay(player_, ui, area);
  if (ui.show_stats) draw_stats_overlay(player_, ui, area);
  if (ui.show_histogram && spread_.histogram) draw_histogram_overlay(*spread_.histogram, ui, area);
  const float below = draw_error_overlay(player_, interface_->ui(), area);
  if (under_cursor_.probe) draw_probe_overlay(*under_cursor_.probe, ui, area, below);
  draw_message_overlay(ui, area);
  return {};
}

void WindowApp::draw_frame_field() {
  Ui& ui = interface_->ui();
  if (!ui.show_frame_field) return;
  const ImVec2 scale = ImGui::GetIO().DisplayFramebufferScale;
  const auto text = afterglow::draw_frame_field(
      ui, {static_cast<float>(area_.width) / scale.x / 2, static_cast<float>(area_.height) / scale.y * 0.75f});
  if (!text || text->empty()) return;
  Transport& t = player_.transport();
  const Footage& footage = player_.footage();
  const auto to =
      position_named(*text, t.position(), t.frames(), t.fps(), [&](int at) { return footage.frame(at).number; });
  if (to) {
    t.go_to(*to, player_.now());
  } else {
    ui.say("'" + *text + "' is no frame: 1001, +12, -3 or 00:01:12");
  }
  redraw_ = kSettle;
}

OverlayPicture WindowApp::overlay_picture() const {
  const Size picture = player_.images().picture, window = picture_window();
  OverlayPicture out{.place = placement(player_.view(), picture, window), .picture = picture, .window = window};
  out.right = area_.width - window.width;
  const ImVec2 scale = ImGui::GetIO().DisplayFramebufferScale;
  out.pixel = {1 / scale.x, 1 / scale.y};
  return out;
}

Result<void> WindowApp::look_under_cursor() {
  const auto at = cursor();
  const Size picture = player_.images().picture;
  const auto pixel = at && picture.area() > 0 ? pixel_at(player_.view(), picture, picture_window(), *at) : std::nullopt;
  if (pixel == under_cursor_.pixel && under_cursor_.turn == turn_) return {};
  under_cursor_ = {pixel, turn_, std::nullopt};
  if (!pixel) return {};
  AFTERGLOW_TRY(under_cursor_.probe, player_.probe(*pixel));
  return {};
}

/// Reads the whole picture back: not for each frame while playing.
Result<void> WindowApp::look_at_histogram() {
  const double now = player_.now();
  if (!interface_->ui().show_histogram || spread_.turn == turn_ || now < spread_.when + kHistogramPause) return {};
  if (player_.images().result.binding.view == VK_NULL_HANDLE) return {};
  AFTERGLOW_TRY(spread_.histogram, player_.histogram());
  spread_.turn = turn_;
  spread_.when = now;
  return {};
}

}  // namespace afterglow
