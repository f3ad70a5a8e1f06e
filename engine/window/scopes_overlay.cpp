// SPDX-License-Identifier: MIT
// Scopes over the picture, with axes, what does not fit, and the means of the region.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "image/srgb.h"
#include "window/overlay.h"
#include "window/sheet.h"

namespace afterglow {
namespace {

constexpr ImU32 kAxis = IM_COL32(255, 255, 255, 60), kTarget = IM_COL32(255, 255, 255, 150);

struct Tick {
  double position = 0;  ///< 0…1
  std::string text;
};

std::vector<Tick> ticks_of(ScopeScale scale) {
  std::vector<Tick> out;
  if (scale == ScopeScale::stops) {
    for (int stop = -8; stop <= 8; stop += 4)
      out.push_back({scope_position(scale, Scopes::kMiddleGrey * std::exp2(stop)), fmt::format("{:+d}", stop)});
    out[2].text = "0";
  } else if (scale == ScopeScale::linear) {
    for (const double value : {0.0, 0.25, 0.5, 0.75, 1.0}) out.push_back({value, fmt::format("{:g}", value)});
  } else {
    for (const int code : {0, 64, 128, 192, 255}) out.push_back({code / 255.0, fmt::format("{}", code)});
  }
  return out;
}

/// A scope's place on the screen, its axes at the left of it or below.
struct Frame {
  ImVec2 from, to;
  float x(double part) const { return from.x + static_cast<float>(part) * (to.x - from.x); }
  float y(double part) const { return to.y - static_cast<float>(part) * (to.y - from.y); }
};

/// On a plate: what a scope shows may be as bright as they are.
void draw_letters(ImDrawList& list, ImVec2 at, const char* text) {
  const ImVec2 size = ImGui::CalcTextSize(text);
  list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, IM_COL32(13, 14, 16, 180));
  list.AddText(at, ui_color::kText, text);
}

float label_width(const Ui& ui) { return ui.px(30); }

void draw_levels(ImDrawList& list, const Ui& ui, const Frame& frame, ScopeScale scale, bool across) {
  const std::vector<Tick> ticks = ticks_of(scale);
  // In little room the ends and the middle have words.
  const float room =
      across ? (frame.to.x - frame.from.x) / label_width(ui) : (frame.to.y - frame.from.y) / ImGui::GetTextLineHeight();
  const std::size_t every = room > 6 ? 1 : room > 3 ? 2 : 4;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const Tick tick{ticks[i].position, i % every == 0 ? ticks[i].text : ""};
    const ImVec2 text = ImGui::CalcTextSize(tick.text.c_str());
    if (across) {
      const float x = frame.x(tick.position);
      list.AddLine({x, frame.from.y}, {x, frame.to.y}, kAxis);
      list.AddText({std::clamp(x - text.x / 2, frame.from.x, frame.to.x - text.x), frame.to.y + ui.px(2)},
                   ui_color::kDim, tick.text.c_str());
    } else {
      const float y = frame.y(tick.position);
      list.AddLine({frame.from.x, y}, {frame.to.x, y}, kAxis);
      list.AddText({frame.from.x - text.x - ui.px(4), std::clamp(y - text.y / 2, frame.from.y, frame.to.y - text.y)},
                   ui_color::kDim, tick.text.c_str());
    }
  }
}

/// Where the colours of bars (75 %) belong, and the hue of skin.
void draw_targets(ImDrawList& list, const Ui& ui, const Frame& frame) {
  struct Target {
    const char* name;
    std::array<double, 3> code;
  };
  constexpr double kOn = 0.75;
  static const Target kTargets[] = {{"R", {kOn, 0, 0}},    {"Yl", {kOn, kOn, 0}}, {"G", {0, kOn, 0}},
                                    {"Cy", {0, kOn, kOn}}, {"B", {0, 0, kOn}},    {"Mg", {kOn, 0, kOn}}};
  const ImVec2 middle{frame.x(0.5), frame.y(0.5)};
  list.AddLine({frame.from.x, middle.y}, {frame.to.x, middle.y}, kAxis);
  list.AddLine({middle.x, frame.from.y}, {middle.x, frame.to.y}, kAxis);
  constexpr double kSkin = 123.0 / 180 * 3.14159265358979;  // from +Cb, towards +Cr
  list.AddLine(middle, {frame.x(0.5 + 0.42 * std::cos(kSkin)), frame.y(0.5 + 0.42 * std::sin(kSkin))}, kTarget);
  for (const Target& target : kTargets) {
    const auto at =
        scope_color({srgb_to_linear(target.code[0]), srgb_to_linear(target.code[1]), srgb_to_linear(target.code[2])});
    const ImVec2 p{frame.x(at[0] + 0.5), frame.y(at[1] + 0.5)};
    const float half = ui.px(5);
    list.AddRect({p.x - half, p.y - half}, {p.x + half, p.y + half}, kTarget);
    draw_letters(list, {p.x + half + ui.px(2), p.y - half}, target.name);
  }
}

void draw_scope(const Ui& ui, const View& view, ScopeKind kind, ImVec2 size) {
  const float labels = label_width(ui), line = ImGui::GetTextLineHeight();
  colored(ui_color::kDim, kind == ScopeKind::vectorscope
                              ? scope_kind_name(kind)
                              : fmt::format("{} · {}", scope_kind_name(kind), scope_scale_name(view.scope_scale)));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::Dummy({size.x + labels, size.y + line + ui.px(2)});
  Frame frame{{at.x + labels, at.y}, {at.x + labels + size.x, at.y + size.y}};
  if (kind == ScopeKind::vectorscope) {  // both directions are alike
    const float spare = size.x - std::min(size.x, size.y);
    frame.from.x += spare / 2;
    frame.to.x -= spare / 2;
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ui.cells.draw(list, static_cast<int>(kind) - 1, frame.from, frame.to);
  if (kind == ScopeKind::vectorscope) {
    draw_targets(list, ui, frame);
  } else {
    draw_levels(list, ui, frame, view.scope_scale, kind == ScopeKind::histogram);
  }
  if (kind == ScopeKind::parade) {
    for (int c = 0; c < 3; ++c)
      draw_letters(list, {frame.x(c / 3.0) + ui.px(3), frame.from.y + ui.px(1)}, c == 0 ? "R" : c == 1 ? "G" : "B");
  }
  list.AddRect(frame.from, frame.to, ui_color::kLine);
}

/// Sizes of one of four scopes, so that they take no more than a good part of the picture, and of what is free.
ImVec2 scope_size(const Ui& ui, const OverlayArea& area, int columns, int rows, float free) {
  const float beside = label_width(ui) + ui.px(12), around = 2 * ImGui::GetTextLineHeight() + ui.px(14);
  const float width = (area.size.x * 0.92f - ui.px(30)) / static_cast<float>(columns) - beside;
  const float height = (std::min(area.size.y * 0.7f, free) - ui.px(60)) / static_cast<float>(rows) - around;
  return {std::clamp(width, ui.px(60), ui.px(256)), std::clamp(height, ui.px(40), ui.px(192))};
}

void draw_counts(const Scopes& scopes) {
  const auto count = [&](const char* name, std::uint64_t n) {
    if (n == 0) return;
    const double part = 100.0 * static_cast<double>(n) / static_cast<double>(std::max<std::uint64_t>(scopes.pixels, 1));
    colored(ui_color::kWarning, fmt::format("{}: {} ({:.2g} %)", name, n, part));
  };
  count("above 1, clipped", scopes.above_one);
  count("below 0, outside Rec.709", scopes.negative);
  count("NaN", scopes.nan);
  count("infinite", scopes.infinite);
  if (scopes.every > 1) colored(ui_color::kDim, fmt::format("1 pixel of {0}×{0}", scopes.every));
}

void draw_mean(const char* name, const RegionMean& mean) {
  std::string text = fmt::format("{:7}", name);
  for (int c = 0; c < 3; ++c) text += fmt::format("{:>9.4g}", mean.mean[static_cast<std::size_t>(c)]);
  const double light = 0.2126 * mean.mean[0] + 0.7152 * mean.mean[1] + 0.0722 * mean.mean[2];
  text += light > 0 ? fmt::format("{:>+7.2f} EV", std::log2(light / Scopes::kMiddleGrey)) : "      - EV";
  ImGui::TextUnformatted(text.c_str());
}

void draw_means(const RegionMeans& means) {
  const Rect& r = means.region;
  colored(ui_color::kDim, fmt::format("mean of {}×{} at {}, {}", r.width, r.height, r.x, r.y));
  draw_mean("source", means.source);
  draw_mean("result", means.result);
  if (means.other) draw_mean("other", *means.other);
  if (means.result.not_finite > 0)
    colored(ui_color::kWarning, fmt::format("{} pixels are not finite and left out", means.result.not_finite));
}

}  // namespace

void draw_scopes_overlay(const ShownScopes& shown, const View& view, const Ui& ui, const OverlayArea& area) {
  const bool scopes = view.scope != ScopeKind::none && shown.scopes;
  if (!scopes && !shown.means) return;
  const int across = view.scope == ScopeKind::all ? 2 : 1;
  const float right = area.at.x + area.size.x - ui.px(14);
  const float widest = static_cast<float>(across) * (ui.px(268) + label_width(ui)) + ui.px(34);
  const auto room = ui.sheets.free(right - widest, right, {area.at.y + ui.px(4), area.at.y + area.size.y - ui.px(14)});
  const float least = ui.px(60) + static_cast<float>(across) * (ui.px(54) + 2 * ImGui::GetTextLineHeight());
  const ImVec2 size = scope_size(ui, area, across, across, room.bottom - room.top);
  begin_sheet("scopes", {right, area.at.y + area.size.y - ui.px(14)}, {1, 1}, ui, ImGuiWindowFlags_NoInputs);
  if (room.bottom - room.top < least) {
    colored(ui_color::kDim, scopes ? "scopes: no room" : "means: no room");
    return end_sheet();
  }
  ImGui::PushFont(ui.mono);
  if (scopes && view.scope == ScopeKind::all) {
    for (const ScopeKind kind :
         {ScopeKind::histogram, ScopeKind::waveform, ScopeKind::parade, ScopeKind::vectorscope}) {
      ImGui::BeginGroup();
      draw_scope(ui, view, kind, size);
      ImGui::EndGroup();
      if (kind == ScopeKind::histogram || kind == ScopeKind::parade) ImGui::SameLine(0, ui.px(12));
    }
  } else if (scopes) {
    draw_scope(ui, view, view.scope, size);
  }
  ImGui::PushTextWrapPos(scopes ? std::max(size.x + label_width(ui), ui.px(140)) : 0.0f);
  if (scopes) draw_counts(*shown.scopes);
  ImGui::PopTextWrapPos();
  if (shown.means) draw_means(*shown.means);
  ImGui::PopFont();
  end_sheet();
}

void draw_region(const Rect& region, const Ui& ui, const OverlayPicture& place) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto corner = [&](int x, int y, int right) {
    const Point p = to_screen(place.place, {static_cast<double>(x), static_cast<double>(y)});
    return ImVec2(static_cast<float>(p.x + right) * place.pixel.x, static_cast<float>(p.y) * place.pixel.y);
  };
  const auto draw = [&](int right) {
    list.PushClipRect({static_cast<float>(right) * place.pixel.x, 0},
                      {static_cast<float>(right + place.window.width) * place.pixel.x,
                       static_cast<float>(place.window.height) * place.pixel.y},
                      true);
    const auto whole = [](ImVec2 at) { return ImVec2(std::floor(at.x), std::floor(at.y)); };  // sharp lines
    const ImVec2 from = whole(corner(region.x, region.y, right));
    const ImVec2 to = whole(corner(region.x + region.width, region.y + region.height, right));
    const float line = ui.px(1);
    list.AddRect({from.x - 2 * line, from.y - 2 * line}, {to.x + 2 * line, to.y + 2 * line}, IM_COL32(0, 0, 0, 200), 0,
                 0, line);
    list.AddRect({from.x - line, from.y - line}, {to.x + line, to.y + line}, ui_color::kAccent, 0, 0, line);
    list.PopClipRect();
  };
  draw(0);
  if (place.right > 0) draw(place.right);
}

}  // namespace afterglow
