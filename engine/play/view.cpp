// SPDX-License-Identifier: MIT
#include "play/view.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace afterglow {
namespace {

Point middle(Size size) { return {size.width / 2.0, size.height / 2.0}; }

bool is_whole(double value) { return std::abs(value - std::round(value)) < 1e-9; }

/// The free zoom and centre that show what is shown now.
void make_free(View& view, Size picture, Size window) {
  if (!view.fit) return;
  view.zoom = fitting_zoom(picture, window);
  view.center = middle(picture);
  view.fit = false;
}

void hold_center(View& view, Size picture) {
  view.center.x = std::clamp(view.center.x, 0.0, static_cast<double>(picture.width));
  view.center.y = std::clamp(view.center.y, 0.0, static_cast<double>(picture.height));
}

}  // namespace

std::string view_channel_name(ViewChannel channel) {
  static constexpr std::array<const char*, 6> kNames{"color", "red", "green", "blue", "alpha", "luminance"};
  return kNames[static_cast<std::size_t>(channel)];
}

std::string compare_name(Compare compare) {
  static constexpr std::array<const char*, 3> kNames{"none", "source", "other"};
  return kNames[static_cast<std::size_t>(compare)];
}

std::string compare_by_name(CompareBy by) {
  static constexpr std::array<const char*, 4> kNames{"wipe", "flip", "side by side", "difference"};
  return kNames[static_cast<std::size_t>(by)];
}

std::string guides_name(Guides guides) {
  constexpr const char* kNames[] = {"none", "thirds", "safe areas", "thirds and safe areas"};
  return kNames[static_cast<std::size_t>(guides)];
}

std::string marks_name(Marks marks) {
  static constexpr std::array<const char*, 3> kNames{"none", "out of range", "stops"};
  return kNames[static_cast<std::size_t>(marks)];
}

std::string scope_kind_name(ScopeKind kind) {
  static constexpr std::array<const char*, 6> kNames{"none",       "histogram",   "waveform",
                                                     "RGB parade", "vectorscope", "all"};
  return kNames[static_cast<std::size_t>(kind)];
}

PictureArea area_of_aspect(Size picture, double ratio) {
  const double width = picture.width, height = picture.height;
  const Point size =
      ratio > 0 ? Point{std::min(width, height * ratio), std::min(height, width / ratio)} : Point{width, height};
  return {{(width - size.x) / 2, (height - size.y) / 2}, {(width + size.x) / 2, (height + size.y) / 2}};
}

PictureArea middle_part(const PictureArea& area, double part) {
  const Point middle{(area.from.x + area.to.x) / 2, (area.from.y + area.to.y) / 2};
  const Point half{(area.to.x - area.from.x) / 2 * part, (area.to.y - area.from.y) / 2 * part};
  return {{middle.x - half.x, middle.y - half.y}, {middle.x + half.x, middle.y + half.y}};
}

bool wipes(const View& view) { return view.compare != Compare::none && view.by == CompareBy::wipe; }

Size picture_window(const View& view, Size window) {
  if (view.compare == Compare::none || view.by != CompareBy::side_by_side) return window;
  return {std::max(window.width / 2, 1), window.height};
}

double fitting_zoom(Size picture, Size window) {
  if (picture.width < 1 || picture.height < 1 || window.width < 1 || window.height < 1) return 1;
  const double zoom =
      std::min(static_cast<double>(window.width) / picture.width, static_cast<double>(window.height) / picture.height);
  return std::clamp(zoom, kLeastZoom, kMostZoom);
}

ViewPlacement placement(const View& view, Size picture, Size window) {
  ViewPlacement out;
  out.scale = view.fit ? fitting_zoom(picture, window) : std::clamp(view.zoom, kLeastZoom, kMostZoom);
  const Point center = view.fit ? middle(picture) : view.center, screen = middle(window);
  out.origin = {screen.x - out.scale * center.x, screen.y - out.scale * center.y};
  if (is_whole(out.scale)) out.origin = {std::round(out.origin.x), std::round(out.origin.y)};
  return out;
}

Point to_screen(const ViewPlacement& p, Point picture) {
  return {p.origin.x + p.scale * picture.x, p.origin.y + p.scale * picture.y};
}

Point to_picture(const ViewPlacement& p, Point screen) {
  return {(screen.x - p.origin.x) / p.scale, (screen.y - p.origin.y) / p.scale};
}

std::optional<Pixel> pixel_at(const View& view, Size picture, Size window, Point screen) {
  const Point at = to_picture(placement(view, picture, window), screen);
  const double x = std::floor(at.x), y = std::floor(at.y);
  if (!(x >= 0 && y >= 0 && x < picture.width && y < picture.height)) return std::nullopt;
  return Pixel{static_cast<int>(x), static_cast<int>(y)};
}

std::optional<Rect> region_between(const View& view, Size picture, Size window, Point a, Point b) {
  const ViewPlacement place = placement(view, picture, window);
  const Point p = to_picture(place, {std::min(a.x, b.x), std::min(a.y, b.y)});
  const Point q = to_picture(place, {std::max(a.x, b.x), std::max(a.y, b.y)});
  const auto pixel = [](double at, int length) {
    return static_cast<int>(std::floor(std::clamp(at, -1.0, length + 0.0)));
  };
  const int x0 = pixel(p.x, picture.width), y0 = pixel(p.y, picture.height);
  const int x1 = pixel(q.x, picture.width), y1 = pixel(q.y, picture.height);
  const Rect region = within({x0, y0, x1 - x0 + 1, y1 - y0 + 1}, picture);
  return region.size().area() > 0 ? std::optional(region) : std::nullopt;
}

void fit(View& view) { view.fit = true; }

void one_to_one(View& view, Size picture, Size window) {
  make_free(view, picture, window);
  view.zoom = 1;
}

void zoom_at(View& view, Size picture, Size window, Point screen, double factor) {
  if (!(factor > 0) || !std::isfinite(factor)) return;
  make_free(view, picture, window);
  const Point under = to_picture(placement(view, picture, window), screen);
  view.zoom = std::clamp(view.zoom * factor, kLeastZoom, kMostZoom);
  const Point center = middle(window);
  view.center = {under.x + (center.x - screen.x) / view.zoom, under.y + (center.y - screen.y) / view.zoom};
  hold_center(view, picture);
}

void pan(View& view, Size picture, Size window, Point by) {
  make_free(view, picture, window);
  view.center = {view.center.x - by.x / view.zoom, view.center.y - by.y / view.zoom};
  hold_center(view, picture);
}

void wipe_to(View& view, Size picture, Size window, Point screen) {
  const Point at = to_picture(placement(view, picture, window), screen);
  const double part = view.wipe_vertical ? at.y / std::max(picture.height, 1) : at.x / std::max(picture.width, 1);
  if (std::isfinite(part)) view.wipe = std::clamp(part, 0.0, 1.0);
}

}  // namespace afterglow
