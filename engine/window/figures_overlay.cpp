// SPDX-License-Identifier: MIT
// Figures over the picture: frame times, reload latency.
#include <fmt/format.h>

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
  if (stats.cache.pixels > 0)
    row("cache", fmt::format("{} MiB, {:.3g} B a pixel", stats.cache.bytes >> 20,
                             static_cast<double>(stats.cache.bytes) / static_cast<double>(stats.cache.pixels)));
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

}  // namespace afterglow
