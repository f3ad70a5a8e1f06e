// SPDX-License-Identifier: MIT
// The mouse over the picture: wheel zooms at the pointer, a drag moves the picture or the wipe, a double click goes
// between fit and 1:1. With Ctrl a drag makes a region, a click removes it.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cmath>

#include "window/ui.h"
#include "window/window_app.h"

namespace afterglow {

namespace {

constexpr double kZoomStep = 1.25;
constexpr float kGrab = 6;  // pixels beside the wipe that still hold it

ImVec2 in_framebuffer(ImVec2 at) {
  const ImVec2 scale = ImGui::GetIO().DisplayFramebufferScale;
  return {at.x * scale.x, at.y * scale.y};
}

}  // namespace

std::optional<Point> WindowApp::cursor() const {
  const ImGuiIO& io = ImGui::GetIO();
  if (!ImGui::IsMousePosValid(&io.MousePos) || (interface_->wants_mouse() && drag_ == Drag::none)) return std::nullopt;
  const ImVec2 at = in_framebuffer(io.MousePos);
  const Point point{static_cast<double>(at.x) - area_.x, static_cast<double>(at.y) - area_.y};
  const bool inside = point.x >= 0 && point.y >= 0 && point.x < area_.width && point.y < area_.height;
  if (!inside && drag_ == Drag::none) return std::nullopt;
  const Size one = picture_window();
  if (one.width < area_.width && point.x >= area_.width - one.width)
    return Point{point.x - (area_.width - one.width), point.y};
  return point;
}

Size WindowApp::picture_window() const { return afterglow::picture_window(player_.view(), area_.size()); }

bool WindowApp::over_wipe(Point at) const {
  const View& view = player_.view();
  const Size picture = player_.images().picture;
  if (!wipes(view) || picture.area() == 0) return false;
  const auto place = placement(view, picture, area_.size());
  const Point border = to_screen(place, {view.wipe * picture.width, view.wipe * picture.height});
  const double distance = view.wipe_vertical ? at.y - border.y : at.x - border.x;
  return std::abs(distance) <= interface_->ui().px(kGrab);
}

void WindowApp::navigate() {
  const ImGuiIO& io = ImGui::GetIO();
  const Size picture = player_.images().picture;
  const auto at = cursor();
  const bool held = ImGui::IsMouseDown(ImGuiMouseButton_Left) || ImGui::IsMouseDown(ImGuiMouseButton_Middle);
  View& view = player_.view();
  const Size window = picture_window();
  // The last way of a drag may come with the button's release.
  if (drag_ == Drag::region && at && picture.area() > 0) {
    const bool moved = std::abs(at->x - drag_from_.x) + std::abs(at->y - drag_from_.y) >= 2;
    if (moved || view.region) view.region = region_between(view, picture, window, drag_from_, *at);
  }
  if (!held) drag_ = Drag::none;
  if (!at || picture.area() == 0 || drag_ == Drag::region) return;

  const bool wipe = drag_ == Drag::wipe || (drag_ == Drag::none && over_wipe(*at));
  if (wipe) ImGui::SetMouseCursor(view.wipe_vertical ? ImGuiMouseCursor_ResizeNS : ImGuiMouseCursor_ResizeEW);
  if (io.MouseWheel != 0) zoom_at(view, picture, window, *at, std::pow(kZoomStep, io.MouseWheel));
  if (double_clicked() && !wipe) {
    if (view.fit) {
      zoom_at(view, picture, window, *at, 1 / fitting_zoom(picture, window));
      view.zoom = 1;
    } else {
      fit(view);
    }
    return;
  }
  const bool pressed = ImGui::IsMouseClicked(ImGuiMouseButton_Left) || ImGui::IsMouseClicked(ImGuiMouseButton_Middle);
  if (pressed && (interface_->press_mods() & GLFW_MOD_CONTROL)) {
    drag_ = Drag::region;
    drag_from_ = *at;
    view.region.reset();
    return;
  }
  if (pressed) drag_ = wipe && !ImGui::IsMouseDown(ImGuiMouseButton_Middle) ? Drag::wipe : Drag::pan;
  if (drag_ == Drag::wipe) wipe_to(view, picture, window, *at);
  const ImVec2 moved = in_framebuffer(io.MouseDelta);
  if (drag_ == Drag::pan && (moved.x != 0 || moved.y != 0)) pan(view, picture, window, {moved.x, moved.y});
}

}  // namespace afterglow
