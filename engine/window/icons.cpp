// SPDX-License-Identifier: MIT
#include "window/icons.h"

namespace afterglow {
namespace {

/// Draws around the middle of the button in a square of side 2, y downwards.
struct Pen {
  ImDrawList& list;
  ImVec2 middle;
  float unit;
  ImU32 color;
  ImVec2 at(float x, float y) const { return {middle.x + x * unit, middle.y + y * unit}; }
  void triangle(float left, float right, bool forward) const {
    if (forward) {
      list.AddTriangleFilled(at(left, -1), at(right, 0), at(left, 1), color);
    } else {
      list.AddTriangleFilled(at(right, -1), at(right, 1), at(left, 0), color);
    }
  }
  void bar(float left, float right) const { list.AddRectFilled(at(left, -1), at(right, 1), color); }
};

void draw(const Pen& pen, Icon icon) {
  switch (icon) {
    case Icon::first:
      pen.bar(-1, -0.6f);
      pen.triangle(-0.5f, 0.9f, false);
      break;
    case Icon::back:
      pen.triangle(-1, 0.2f, false);
      pen.bar(0.5f, 0.9f);
      break;
    case Icon::pause:
      pen.bar(-0.8f, -0.2f);
      pen.bar(0.2f, 0.8f);
      break;
    case Icon::play:
      pen.triangle(-0.8f, 0.8f, true);
      break;
    case Icon::on:
      pen.bar(-0.9f, -0.5f);
      pen.triangle(-0.2f, 1, true);
      break;
    case Icon::last:
      pen.triangle(-0.9f, 0.5f, true);
      pen.bar(0.6f, 1);
      break;
  }
}

}  // namespace

float icon_button_width(const Ui& ui) { return ui.px(34); }

bool icon_button(const Ui& ui, const char* id, Icon icon, const std::string& help, bool lit) {
  const bool pressed = ImGui::Button(id, {icon_button_width(ui), 0});
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  draw({*ImGui::GetWindowDrawList(),
        {(from.x + to.x) / 2, (from.y + to.y) / 2},
        (to.y - from.y) * 0.24f,
        lit ? ui_color::kAccent : ui_color::kText},
       icon);
  ui.help(help);
  return pressed;
}

}  // namespace afterglow
