// SPDX-License-Identifier: MIT
// Figures over the picture: frame times, reload latency, histogram.
#include <fmt/format.h>

#include <algorithm>

#include "window/overlay.h"
#include "window/sheet.h"

namespace afterglow {

void draw_stats_overlay(const Player& player, const Ui& ui, const OverlayArea& area) {
  const PlayerStats stats = player.stats();
  begin_sheet("stats", {area.at.x + area.size.x - ui.px(14), area.at.y + ui.px(14)}, {1, 0}, ui,
              ImGuiWindowFlags_NoInputs);
  ImGui::PushFont(ui.mono);
  const auto row = [](const char* name, const std::string& value, ImU32 color = ui_color::kText) {
    colored(ui_color::kDim, fmt::format("{:9}", name));
    ImGui::SameLine();
    colored(color, fmt::format("{:>24}", value));
  };
  row("fps", fmt::format("{:.1f}", stats.fps));
  row("interval",
      fmt::format("{:.1f} / {:.1f} / {:.1f} ms", stats.interval.median, stats.interval.p95, stats.interval.p99));
  row("work", fmt::format("{:.1f} / {:.1f} / {:.1f} ms", stats.work.median, stats.work.p95, stats.work.p99));
  row("shown", fmt::format("{}", stats.shown));
  row("dropped", fmt::format("{}", stats.dropped), stats.dropped > 0 ? ui_color::kWarning : ui_color::kText);
  row("late", fmt::format("{}", stats.late), stats.late > 0 ? ui_color::kWarning : ui_color::kText);
  if (stats.rebuilding > 0) row("building", fmt::format("{}", stats.rebuilding), ui_color::kWarning);
  row("reloads", fmt::format("{}", stats.reloads));
  if (!stats.latencies.empty()) {
    const ReloadLatency& last = stats.latencies.back();
    ImGui::Separator();
    row("reload", fmt::format("{:.1f} ms", last.total()), ui_color::kAccent);
    row("notice", fmt::format("{:.1f}", last.build.notice));
    row("script", fmt::format("{:.1f}", last.build.script));
    row("shader", fmt::format("{:.1f}", last.build.shader));
    row("pipeline", fmt::format("{:.1f}", last.build.pipeline));
    row("warm-up", fmt::format("{:.1f}", last.build.warm_up));
    row("wait", fmt::format("{:.1f}", last.build.wait));
    row("execute", fmt::format("{:.1f}", last.execute));
    row("present", fmt::format("{:.1f}", last.present));
  }
  ImGui::PopFont();
  end_sheet();
}

void draw_histogram_overlay(const Histogram& histogram, const Ui& ui, const OverlayArea& area) {
  begin_sheet("histogram", {area.at.x + area.size.x - ui.px(14), area.at.y + area.size.y - ui.px(14)}, {1, 1}, ui,
              ImGuiWindowFlags_NoInputs);
  const ImVec2 size{ui.px(256), ui.px(110)}, at = ImGui::GetCursorScreenPos();
  ImGui::Dummy(size);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  // The ends hold all that is beyond them: they do not set the height.
  std::uint32_t most = 1;
  for (std::size_t c = 0; c < 3; ++c) {
    for (int i = 1; i + 1 < Histogram::kCodes; ++i)
      most = std::max(most, histogram.display[c][static_cast<std::size_t>(i)]);
  }
  const ImU32 colors[] = {IM_COL32(235, 80, 70, 120), IM_COL32(90, 200, 90, 120), IM_COL32(80, 130, 250, 120)};
  for (std::size_t c = 0; c < 3; ++c) {
    for (int i = 0; i < Histogram::kCodes; ++i) {
      const float part = std::min(
          1.0f, static_cast<float>(histogram.display[c][static_cast<std::size_t>(i)]) / static_cast<float>(most));
      if (part <= 0) continue;
      const float x0 = at.x + size.x * static_cast<float>(i) / Histogram::kCodes;
      const float x1 = at.x + size.x * static_cast<float>(i + 1) / Histogram::kCodes;
      list.AddRectFilled({x0, at.y + size.y * (1 - part)}, {x1, at.y + size.y}, colors[c]);
    }
  }
  list.AddRect(at, {at.x + size.x, at.y + size.y}, ui_color::kLine);
  ImGui::PushFont(ui.mono);
  const auto count = [](const char* name, std::uint64_t n) {
    if (n > 0) colored(ui_color::kWarning, fmt::format("{} {}", n, name));
  };
  count("below 0", histogram.negative);
  count("above 1", histogram.above_one);
  count("NaN", histogram.nan);
  count("infinite", histogram.infinite);
  ImGui::PopFont();
  end_sheet();
}

}  // namespace afterglow
