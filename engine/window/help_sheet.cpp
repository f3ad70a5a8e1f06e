// SPDX-License-Identifier: MIT
#include "window/help_sheet.h"

#include <algorithm>
#include <cstring>

#include "core/text.h"
#include "window/shortcuts.h"

namespace afterglow {
namespace {

constexpr float kCellSpacing = 2;  // pixels of a plain display, between lines

// The keys of each action once, in one group.
void draw_group(const Ui& ui, const char* group) {
  ImGui::PushFont(ui.bold);
  ImGui::TextUnformatted(group);
  ImGui::PopFont();
  if (!ImGui::BeginTable(group, 2, ImGuiTableFlags_SizingFixedFit)) return;
  const Shortcut* last = nullptr;
  for (const Shortcut& shortcut : shortcuts()) {
    if (std::strcmp(shortcut.group, group) != 0) continue;
    const bool again = last && last->action == shortcut.action;
    last = &shortcut;
    if (again) continue;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::PushFont(ui.mono);
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(ui_color::kAccent), "%s", keys_of(shortcut.action).c_str());
    ImGui::PopFont();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(shortcut.doc);
  }
  ImGui::EndTable();
  ImGui::Spacing();
}

}  // namespace

std::vector<HelpGroup> help_groups() {
  std::vector<HelpGroup> out;
  const Shortcut* last = nullptr;
  for (const Shortcut& shortcut : shortcuts()) {
    if (out.empty() || std::strcmp(out.back().name, shortcut.group) != 0) out.push_back({shortcut.group, 2});
    if (!last || last->action != shortcut.action) ++out.back().lines;
    last = &shortcut;
  }
  return out;
}

HelpLayout help_layout(const std::vector<HelpGroup>& groups, int columns) {
  HelpLayout best;
  std::vector<int> column(groups.size(), 0);
  // Every way to part them in their order: there are few.
  const auto part = [&](auto&& self, std::size_t first, int at) -> void {
    if (at + 1 < columns) {
      for (std::size_t end = first; end <= groups.size(); ++end) {
        std::fill(column.begin() + static_cast<std::ptrdiff_t>(first),
                  column.begin() + static_cast<std::ptrdiff_t>(end), at);
        self(self, end, at + 1);
      }
      return;
    }
    std::fill(column.begin() + static_cast<std::ptrdiff_t>(first), column.end(), at);
    std::vector<int> heights(static_cast<std::size_t>(columns), 0);
    for (std::size_t i = 0; i < groups.size(); ++i) heights[static_cast<std::size_t>(column[i])] += groups[i].lines;
    const int height = *std::ranges::max_element(heights);
    if (best.column.empty() || height < best.height) best = {column, height};
  };
  part(part, 0, 0);
  return best;
}

std::string keys_page() {
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>Keys of afterglow play</title>\n<style>\n"
      "@page { size: A4; margin: 12mm }\n"
      "body { font: 8.5pt/1.3 \"DejaVu Sans\", sans-serif; columns: 2; column-gap: 8mm; color: #000; background: #fff "
      "}\n"
      "h1 { font-size: 13pt; margin: 0 0 2mm; column-span: all }\n"
      "h2 { font-size: 10pt; margin: 2mm 0 1mm; break-after: avoid }\n"
      "table { border-collapse: collapse; width: 100% }\n"
      "tr { break-inside: avoid; border-bottom: 0.2mm solid #ccc }\n"
      "td { padding: 0.3mm 1mm; vertical-align: top }\n"
      "td:first-child { font-family: \"DejaVu Sans Mono\", monospace; white-space: nowrap; width: 1% }\n"
      "</style>\n<h1>Keys of afterglow play</h1>\n";
  const char* group = "";
  const Shortcut* last = nullptr;
  for (const Shortcut& shortcut : shortcuts()) {
    if (std::strcmp(shortcut.group, group) != 0) {
      out += (*group ? "</table>\n<h2>" : "<h2>") + markup_text(shortcut.group) + "</h2>\n<table>\n";
      group = shortcut.group;
    }
    if (!last || last->action != shortcut.action)
      out +=
          "<tr><td>" + markup_text(keys_of(shortcut.action)) + "</td><td>" + markup_text(shortcut.doc) + "</td></tr>\n";
    last = &shortcut;
  }
  return out + "</table>\n</html>\n";
}

void draw_help_sheet(Ui& ui, ImVec2 area) {
  if (!ui.show_help) return;
  ImGui::SetNextWindowPos({area.x / 2, area.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {area.x * 0.98f, area.y * 0.98f});
  constexpr int kFlags = ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings;
  ImGui::SetNextWindowFocus();
  if (ImGui::Begin("Keys", &ui.show_help, kFlags)) {
    ImGui::SetWindowFontScale(1);  // what follows is measured so
    const std::vector<HelpGroup> groups = help_groups();
    const int columns = std::clamp(static_cast<int>(area.x / ui.px(520)), 1, 3);  // what the longest words take
    const HelpLayout layout = help_layout(groups, columns);
    const float line = ImGui::GetTextLineHeight() + kCellSpacing * ui.scale;
    const float room = area.y * 0.98f - 2 * ImGui::GetFrameHeightWithSpacing() - 2 * ImGui::GetTextLineHeight();
    // Smaller words rather than a sheet that scrolls, as long as they can be read.
    ImGui::SetWindowFontScale(std::clamp(room / (static_cast<float>(layout.height) * line), 0.75f, 1.0f));
    ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, ImVec2(ui.px(4), kCellSpacing * ui.scale / 2));
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(ui.px(6), ui.px(2)));
    for (int column = 0; column < columns; ++column) {
      if (column > 0) ImGui::SameLine(0, ui.px(24));
      ImGui::BeginGroup();
      for (std::size_t i = 0; i < groups.size(); ++i)
        if (layout.column[i] == column) draw_group(ui, groups[i].name);
      ImGui::EndGroup();
    }
    ImGui::PopStyleVar(2);
    ImGui::TextDisabled(
        "Wheel: zoom at the pointer. Drag: move the picture, or the wipe's border; with Ctrl: a region. Double click: "
        "between fit "
        "and 1:1.\n"
        "Double click (or Ctrl+click) a slider: type a value. Right click a setting: as in the file, or its default.");
  }
  ImGui::SetWindowFontScale(1);  // its title, and what it needs for that
  // Tables and the sheet around them take a few frames to agree on their sizes.
  constexpr int kFrames = 6;
  if (ImGui::IsWindowAppearing() || area.x != ui.help_area.x || area.y != ui.help_area.y) ui.help_settles = kFrames;
  ui.help_area = area;
  if (ui.help_settles > 0) {
    --ui.help_settles;
    ui.again();
  }
  ImGui::End();
}

}  // namespace afterglow
