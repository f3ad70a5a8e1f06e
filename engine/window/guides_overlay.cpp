// SPDX-License-Identifier: MIT
// Lines to compose by, and the form that a picture is delivered in. Of the view alone: no file has them.
#include <cmath>
#include <initializer_list>

#include "window/overlay.h"

namespace afterglow {
namespace {

constexpr ImU32 kBesideForm = IM_COL32(0, 0, 0, 216);  // what is left out can still be made out
constexpr ImU32 kGuideLight = IM_COL32(255, 255, 255, 200), kGuideDark = IM_COL32(0, 0, 0, 160);

/// One picture's part of the window; `right`: how far its left border is from the window's.
class GuideArea {
 public:
  GuideArea(const OverlayPicture& place, int right) : place_(place), right_(right) {}

  ImVec2 at(double x, double y) const {
    const Point p = to_screen(place_.place, {x, y});
    return {static_cast<float>(p.x + right_) * place_.pixel.x, static_cast<float>(p.y) * place_.pixel.y};
  }
  ImVec2 window_from() const { return {static_cast<float>(right_) * place_.pixel.x, 0}; }
  ImVec2 window_to() const {
    return {static_cast<float>(right_ + place_.window.width) * place_.pixel.x,
            static_cast<float>(place_.window.height) * place_.pixel.y};
  }

 private:
  const OverlayPicture& place_;
  int right_;
};

/// Along one axis: light beside dark shows on any picture.
void guide_line(ImDrawList& list, ImVec2 from, ImVec2 to, float width) {
  const auto whole = [](float x) { return std::floor(x); };
  from = {whole(from.x), whole(from.y)}, to = {whole(to.x), whole(to.y)};
  const ImVec2 across = from.x == to.x ? ImVec2{width, 0} : ImVec2{0, width};
  list.AddRectFilled(from, {to.x + across.x, to.y + across.y}, kGuideLight);
  list.AddRectFilled({from.x + across.x, from.y + across.y}, {to.x + 2 * across.x, to.y + 2 * across.y}, kGuideDark);
}

void guide_outline(ImDrawList& list, const GuideArea& on, const PictureArea& area, float width) {
  const ImVec2 from = on.at(area.from.x, area.from.y), to = on.at(area.to.x, area.to.y);
  guide_line(list, from, {to.x, from.y}, width);
  guide_line(list, {from.x, to.y}, to, width);
  guide_line(list, from, {from.x, to.y}, width);
  guide_line(list, {to.x, from.y}, to, width);
}

void darken_beside(ImDrawList& list, const GuideArea& on, const PictureArea& area, Size picture) {
  const double width = picture.width, height = picture.height;
  list.AddRectFilled(on.at(0, 0), on.at(width, area.from.y), kBesideForm);
  list.AddRectFilled(on.at(0, area.to.y), on.at(width, height), kBesideForm);
  list.AddRectFilled(on.at(0, area.from.y), on.at(area.from.x, area.to.y), kBesideForm);
  list.AddRectFilled(on.at(area.to.x, area.from.y), on.at(width, area.to.y), kBesideForm);
}

void draw_thirds(ImDrawList& list, const GuideArea& on, const PictureArea& area, float width) {
  for (const double part : {1.0 / 3, 2.0 / 3}) {
    const double x = std::lerp(area.from.x, area.to.x, part), y = std::lerp(area.from.y, area.to.y, part);
    guide_line(list, on.at(x, area.from.y), on.at(x, area.to.y), width);
    guide_line(list, on.at(area.from.x, y), on.at(area.to.x, y), width);
  }
  const ImVec2 middle = on.at((area.from.x + area.to.x) / 2, (area.from.y + area.to.y) / 2);
  const float arm = 8 * width;
  guide_line(list, {middle.x - arm, middle.y}, {middle.x + arm, middle.y}, width);
  guide_line(list, {middle.x, middle.y - arm}, {middle.x, middle.y + arm}, width);
}

}  // namespace

void draw_guides(const View& view, const Ui& ui, const OverlayPicture& place) {
  if (place.picture.area() == 0 || (view.guides == Guides::none && view.aspect == 0)) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const PictureArea area = area_of_aspect(place.picture, kAspects[view.aspect].ratio);
  const bool thirds = view.guides == Guides::thirds || view.guides == Guides::both;
  const bool safe = view.guides == Guides::safe_areas || view.guides == Guides::both;
  const auto draw = [&](int right) {
    const GuideArea on(place, right);
    list.PushClipRect(on.window_from(), on.window_to(), true);
    if (view.aspect != 0) darken_beside(list, on, area, place.picture);
    if (thirds) draw_thirds(list, on, area, ui.px(1));
    if (safe) {
      for (const double part : {0.93, 0.9}) guide_outline(list, on, middle_part(area, part), ui.px(1));
    }
    list.PopClipRect();
  };
  draw(0);
  if (place.right > 0) draw(place.right);
}

}  // namespace afterglow
