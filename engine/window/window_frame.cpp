// SPDX-License-Identifier: MIT
// A frame of a window that plays: the interface, the picture, what is drawn over it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "window/frame_field.h"
#include "window/scope_picture.h"
#include "window/window_app.h"

namespace afterglow {

namespace {

constexpr float kPanelWidth = 376, kTransportHeight = 78;
constexpr float kMostTransport = 0.6f;  // of the window's height
constexpr int kMostRowsBeside = 2;      // of the bar, beside the panel
constexpr double kRetry = 0.02;         // when the window could not be drawn to

ViewImage view_image(const DeviceImage& image) {
  ViewImage out{.view = image.binding.view, .layout = image.layout, .size = image.binding.size};
  const VkFormat format = image.binding.format;
  out.half = format == VK_FORMAT_R16G16B16A16_SFLOAT;
  if (out.half || format == VK_FORMAT_R32G32B32A32_SFLOAT) {
    out.pixels = image.pixels;
    out.row_pitch = image.row_pitch;
  }
  return out;
}

}  // namespace

Result<void> WindowApp::follow_scale() {
  if (interface_->set_scale(options_.scale.value_or(window_.content_scale()))) {
    AFTERGLOW_CHECK(painter_->take_fonts());
  }
  return {};
}

Result<void> WindowApp::draw() {
  AFTERGLOW_CHECK(follow_scale());
  const auto [extent, window] = window_.extent();
  if (window.area() == 0) return {};
  Ui& ui = interface_->ui();
  ui.now = player_.now();
  ui.hover.begin_frame();
  interface_->begin(extent, window);
  follow_pane();
  draw_parts(window);
  navigate();
  AFTERGLOW_CHECK(draw_overlays());
  draw_frame_field();
  if (options_.dialogs) options_.dialogs(player_, ui);
  quit_when_saved();
  ask_about_quitting();
  if (options_.help && ui.show_help) options_.help(player_, ui, {0, 0}, ImGui::GetIO().DisplaySize);
  ui.item_menu = false;
  const ImDrawData& data = interface_->end();
  const auto written = ui.cells.take_written();
  atlas_parts_.insert(atlas_parts_.end(), written.begin(), written.end());
  AFTERGLOW_TRY(const auto drawn, painter_->paint(window, view_frames(), data, atlas_parts_));
  if (drawn == Swapchain::Drawn::yes) atlas_parts_.clear();
  last_draw_ = player_.now();
  if (drawn == Swapchain::Drawn::yes && redraw_ > 0) --redraw_;
  tell_captured();
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

/// Where the window's picture went, or why it went nowhere.
void WindowApp::tell_captured() {
  const auto captured = painter_->take_captured();
  if (!captured) return;
  interface_->ui().say(*captured ? "written: " + (*captured)->string() : captured->error().text());
  diagnostics_.note(*captured ? "window written to " + (*captured)->string() : captured->error().text());
  redraw_ = kSettle;
}

/// A frame around the part that has the keyboard.
void WindowApp::mark_pane(Pane pane, ImVec2 at, ImVec2 size) const {
  const Ui& ui = interface_->ui();
  if (ui.pane != pane) return;
  const float line = ui.px(2);
  ImGui::GetForegroundDrawList()->AddRect({at.x + line / 2, at.y + line / 2},
                                          {at.x + size.x - line / 2, at.y + size.y - line / 2}, ui_color::kAccent, 0, 0,
                                          line);
}

/// The panel at the right, the transport at the bottom, the rest is the picture's.
void WindowApp::draw_parts(Size window) {
  Ui& ui = interface_->ui();
  const ImGuiIO& io = ImGui::GetIO();
  const float width = io.DisplaySize.x, height = io.DisplaySize.y;
  const float panel = options_.panel && ui.show_panel ? std::min(ui.px(kPanelWidth), width * 0.6f) : 0;
  const auto shape = [&](float wide) {
    return options_.transport_shape ? options_.transport_shape(ui, wide) : BarShape{1, ui.px(kTransportHeight)};
  };
  // In a narrow window the bar has its whole width, and the panel ends above it.
  const bool whole = shape(width - panel).rows > kMostRowsBeside;
  const float bar_width = whole ? width : width - panel;
  const float bar =
      options_.transport && ui.show_transport ? std::min(shape(bar_width).height, height * kMostTransport) : 0;
  const float panel_height = whole ? height - bar : height;
  player_.time_kernels(panel > 0);  // it shows what effects cost
  if (panel > 0) {
    options_.panel(player_, ui, {width - panel, 0}, {panel, panel_height});
    mark_pane(Pane::panel, {width - panel, 0}, {panel, panel_height});
  } else if (options_.hidden_panel) {
    options_.hidden_panel(player_, ui);
  }
  if (bar > 0) {
    options_.transport(player_, ui, {0, height - bar}, {bar_width, bar});
    mark_pane(Pane::bar, {0, height - bar}, {bar_width, bar});
  }
  const float strip = options_.strip && options_.strip_height ? options_.strip_height(ui, width - panel) : 0;
  if (strip > 0) {
    options_.strip(player_, ui, {0, height - bar - strip}, {width - panel, strip});
    mark_pane(Pane::strip, {0, height - bar - strip}, {width - panel, strip});
  }
  const float sx = io.DisplayFramebufferScale.x, sy = io.DisplayFramebufferScale.y;
  area_ = {0, 0, std::max(window.width - static_cast<int>(std::lround(panel * sx)), 1),
           std::max(window.height - static_cast<int>(std::lround((bar + strip) * sy)), 1)};
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
  frame.content = turn_;
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
  AFTERGLOW_CHECK(look_at_scopes());
  const Ui& ui = interface_->ui();
  const OverlayArea area{ImVec2(0, 0),
                         ImVec2(static_cast<float>(area_.width) / ImGui::GetIO().DisplayFramebufferScale.x,
                                static_cast<float>(area_.height) / ImGui::GetIO().DisplayFramebufferScale.y)};
  const OverlayPicture place = overlay_picture();
  draw_guides(player_.view(), ui, place);
  if (const auto& region = player_.view().region) draw_region(*region, ui, place);
  if (under_cursor_.probe) draw_pixel_mark(under_cursor_.probe->pixel, ui, place);
  // Those at the top and those at the bottom, in the order in which they have the right of way.
  draw_state_overlay(player_, ui, area);
  if (ui.show_stats) draw_stats_overlay(player_, ui, area);
  draw_frame_mark(player_, ui, place, area);
  draw_error_overlay(player_, interface_->ui(), area);
  if (under_cursor_.probe) draw_probe_overlay(*under_cursor_.probe, player_.view(), ui, area);
  draw_scopes_overlay(scopes_.found, player_.view(), ui, area);
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
  const Footage::Clip& clip = footage.clips()[static_cast<std::size_t>(footage.clip_at(t.position()))];
  const auto to = position_named(*text, {.position = t.position(),
                                         .frames = t.frames(),
                                         .clip_first = clip.first,
                                         .clip_frames = clip.frames,
                                         .fps = t.fps(),
                                         .number = [&](int at) { return footage.frame(at).number; }});
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

bool WindowApp::scopes_due() const {
  const View& view = player_.view();
  if (view.scope == ScopeKind::none && !view.region) return false;
  return scopes_.turn != turn_ || scopes_.kind != view.scope || scopes_.scale != view.scope_scale ||
         scopes_.region != view.region || scopes_.cells != interface_->ui().cells.generation();
}

/// Reads the whole picture back: not for each frame while playing.
Result<void> WindowApp::look_at_scopes() {
  const double now = player_.now();
  const View& view = player_.view();
  if (!view.region) scopes_.found.means.reset();
  if (!scopes_due() || (now < scopes_.when + kScopesPause && scopes_.turn != turn_)) return {};
  if (player_.images().result.binding.view == VK_NULL_HANDLE) return {};
  AtlasCells& cells = interface_->ui().cells;
  if (view.scope != ScopeKind::none) {
    AFTERGLOW_TRY(scopes_.found.scopes, player_.scopes({.scale = view.scope_scale, .region = view.region}));
    for (const ScopeKind kind : {ScopeKind::histogram, ScopeKind::waveform, ScopeKind::parade, ScopeKind::vectorscope})
      if (view.scope == kind || view.scope == ScopeKind::all)
        cells.write(static_cast<int>(kind) - 1, scope_picture(*scopes_.found.scopes, kind));
  }
  if (view.region) {
    AFTERGLOW_TRY(scopes_.found.means, player_.means(*view.region));
  }
  redraw_ = std::max(redraw_, kSettle);  // the sheet finds its size
  scopes_.turn = turn_;
  scopes_.when = now;
  scopes_.kind = view.scope;
  scopes_.scale = view.scope_scale;
  scopes_.region = view.region;
  scopes_.cells = cells.generation();
  return {};
}

}  // namespace afterglow
