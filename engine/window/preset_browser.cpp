// SPDX-License-Identifier: MIT
#include "window/preset_browser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "window/panel_row.h"

namespace afterglow {
namespace {

constexpr float kRowGap = 8;

float row_height(const Ui& ui) { return ui.px(Thumbnail::kHeight + kRowGap); }

}  // namespace

void PresetBrowser::open(std::vector<ListedPreset> presets, const std::filesystem::path& present, Source source) {
  open_ = scroll_ = true;
  search_.open();
  presets_ = std::move(presets);
  present_ = present;
  source_ = std::move(source);
  wanted_.clear();
  asked_.reset();
  const auto same = [&](const ListedPreset& one) {
    std::error_code none;
    return std::filesystem::equivalent(one.file, present_, none);
  };
  const auto at = std::ranges::find_if(presets_, same);
  chosen_ = at == presets_.end() ? 0 : static_cast<std::size_t>(at - presets_.begin());
}

std::optional<PresetChoice> PresetBrowser::draw(Ui& ui, const std::string& unsaved, ImVec2 area) {
  if (!open_) return std::nullopt;
  const auto found = found_presets(presets_, search_.text());
  std::optional<PresetChoice> choice;
  // No more rows are seen at once than the atlas has cells.
  const float most = row_height(ui) * (AtlasCells::kThumbnails - 2) + 4 * ImGui::GetFrameHeightWithSpacing();
  const ImVec2 size{std::min(ui.px(680), area.x * 0.95f), std::min({ui.px(640), area.y * 0.92f, most})};
  ImGui::SetNextWindowPos({(area.x - size.x) / 2, (area.y - size.y) / 2});
  ImGui::SetNextWindowSize(size);
  constexpr int kFlags = ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_NoSavedSettings;
  if (ImGui::Begin("Open a preset", &open_, kFlags)) {
    const SearchTurn turn = search_.draw(ui, "##preset", "Search presets; Up, Down, Enter; Shift+Enter: as B");
    if (turn.go(chosen_, found.size())) {
      scroll_ = true;
      asked_.reset();
    }
    bool entered = turn.entered, left = turn.left;
    draw_list(ui, found, entered);
    const bool any = !found.empty();
    bool other = entered && ImGui::GetIO().KeyShift;
    if (asked_) {
      ImGui::PushStyleColor(ImGuiCol_Text, ui_color::kWarning);
      ImGui::TextUnformatted((unsaved + " would be lost.").c_str());
      ImGui::PopStyleColor();
      ImGui::SameLine();
    }
    if (small_button(ui, asked_ ? "Open all the same###open" : "Open###open", "Enter", any)) entered = true;
    ImGui::SameLine();
    if (small_button(ui, "Open as B", "Shift+Enter: it is compared with the present one", any)) entered = other = true;
    ImGui::SameLine();
    if (small_button(ui, "Cancel", "Esc")) left = true;
    if (!asked_) {
      ImGui::SameLine();
      ImGui::TextDisabled("%s", fmt::format("{} of {}", found.size(), presets_.size()).c_str());
    }
    if (entered && any) {
      const auto& file = found[chosen_]->file;
      if (other || unsaved.empty() || asked_ == file) {
        choice = {file, other};
      } else {
        asked_ = file;
        search_.take_keyboard(ui);
      }
    }
    if (left && asked_ && !choice) {
      asked_.reset();  // the first Escape takes the question back
      search_.take_keyboard(ui);
    } else if (left) {
      open_ = false;
    }
  }
  ImGui::End();
  if (choice) open_ = false;
  return choice;
}

void PresetBrowser::draw_list(Ui& ui, const Found& found, bool& entered) {
  const float height = row_height(ui);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(ui.px(8), 0));
  ImGui::BeginChild("list", {0, -ImGui::GetFrameHeightWithSpacing() - ui.px(4)}, true);
  const float shown = ImGui::GetWindowHeight() - 2 * ImGui::GetStyle().WindowPadding.y;
  if (found.empty()) ImGui::TextDisabled("No preset is called so");
  if (std::exchange(scroll_, false)) {
    const float at = static_cast<float>(chosen_) * height;
    if (at < ImGui::GetScrollY()) ImGui::SetScrollY(at);
    if (at + height > ImGui::GetScrollY() + shown) ImGui::SetScrollY(at + height - shown);
  }
  const float width = ImGui::GetContentRegionAvail().x;
  const auto count = static_cast<int>(found.size());
  const int first = std::clamp(static_cast<int>(ImGui::GetScrollY() / height), 0, count);
  const int last = std::min(first + static_cast<int>(shown / height) + 2, count);
  want_thumbnails(found, first, last);
  const ImVec2 begin = ImGui::GetCursorPos();
  for (int row = first; row < last; ++row) {
    const ListedPreset& preset = *found[static_cast<std::size_t>(row)];
    ImGui::SetCursorPos({begin.x, begin.y + static_cast<float>(row) * height});
    const ImVec2 at = ImGui::GetCursorPos();
    ImGui::PushID(row);
    if (ImGui::Selectable("##row", static_cast<std::size_t>(row) == chosen_, ImGuiSelectableFlags_AllowDoubleClick,
                          {0, height})) {
      if (chosen_ != static_cast<std::size_t>(row)) asked_.reset();
      chosen_ = static_cast<std::size_t>(row);
      search_.take_keyboard(ui);
      if (double_clicked()) entered = true;
    }
    ui.help(preset.file.string());
    ImGui::SetCursorPos(at);
    draw_row(ui, preset, row % AtlasCells::kThumbnails, width);
    ImGui::PopID();
  }
  // All rows have their room, also those that are not drawn.
  ImGui::SetCursorPos({begin.x, begin.y + static_cast<float>(count) * height});
  ImGui::Dummy({1, 0});
  ImGui::EndChild();
  ImGui::PopStyleVar();
}

/// A thumbnail, the name, the story; what is wrong in place of the story.
void PresetBrowser::draw_row(Ui& ui, const ListedPreset& preset, int cell, float width) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 from{corner.x + ui.px(4), corner.y + ui.px(kRowGap / 2)};
  const ImVec2 to{from.x + ui.px(Thumbnail::kWidth), from.y + ui.px(Thumbnail::kHeight)};
  const auto thumbnail = source_.find ? source_.find(preset.file) : nullptr;
  cells_[static_cast<std::size_t>(cell)].draw(ui, AtlasCells::kScopes + cell, thumbnail, from, to);

  const float left = ui.px(Thumbnail::kWidth + 16);
  ImGui::PushClipRect(corner, {corner.x + width, to.y}, true);
  ImGui::SetCursorScreenPos({corner.x + left, from.y});
  ImGui::BeginGroup();
  std::error_code none;
  ImGui::PushFont(ui.bold);
  ImGui::TextUnformatted(preset.name.c_str());
  ImGui::PopFont();
  if (std::filesystem::equivalent(preset.file, present_, none)) {
    ImGui::SameLine();
    ImGui::TextDisabled("is played");
  }
  const bool wrong = thumbnail && thumbnail->error;
  ImGui::PushStyleColor(ImGuiCol_Text, wrong ? ui_color::kError : ui_color::kDim);
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + std::max(width - left - ui.px(4), ui.px(40)));
  const std::string text = wrong ? "Error: " + thumbnail->error->text() : preset.story;
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
  ImGui::EndGroup();
  ImGui::PopClipRect();
}

/// Those that are seen first, then the chosen one's neighbours: the whole list, as it goes on from there.
void PresetBrowser::want_thumbnails(const Found& found, int first, int last) {
  if (!source_.want) return;
  std::vector<std::filesystem::path> wanted;
  const auto add = [&](int from, int to) {
    for (int row = from; row < to; ++row) wanted.push_back(found[static_cast<std::size_t>(row)]->file);
  };
  add(first, last);
  add(last, static_cast<int>(found.size()));
  add(0, first);
  if (wanted.size() > Thumbnails::kMostKept) wanted.resize(Thumbnails::kMostKept);
  if (wanted == wanted_) return;
  wanted_ = wanted;
  source_.want(std::move(wanted));
}

}  // namespace afterglow
