// SPDX-License-Identifier: MIT
#include "window/effect_browser.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/text.h"
#include "script/preset.h"
#include "window/panel_row.h"
#include "window/ui.h"

namespace afterglow {

void EffectLibrary::read(const SearchPath& path) {
  if (reading()) return;
  running_ = std::async(std::launch::async, [path] {
    Diagnostics silent;  // a broken script is left out: the preset that names it tells why
    Read out;
    if (auto effects = list_effects(path, silent)) out.effects = std::move(*effects);
    if (auto masks = list_masks(path, silent)) out.masks = std::move(*masks);
    return out;
  });
}

void EffectLibrary::poll() {
  if (reading() && running_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) read_ = running_.get();
}

void EffectBrowser::open(Source source) {
  open_ = true;
  search_.open();
  source_ = std::move(source);
  wanted_.clear();
  entered_ = false;
  chosen_ = 0;
}

/// Every word of the search, in the name or the doc.
bool EffectBrowser::found(const EffectSchema& effect) const {
  const std::string text = lower(effect.name + " " + effect.doc + " " + effect.at);
  const auto words = split(lower(search_.text()), ' ');
  return std::ranges::all_of(words, [&](const std::string& word) { return text.find(word) != std::string::npos; });
}

std::optional<std::string> EffectBrowser::draw(Ui& ui, const EffectLibrary& library, ImVec2 at, ImVec2 size) {
  if (!open_) return std::nullopt;
  const bool reading = library.reading() && library.effects().empty();
  if (reading) ui.again();
  std::vector<const EffectSchema*> list;
  for (const EffectSchema& effect : library.effects())
    if (found(effect)) list.push_back(&effect);
  // Those whose name begins so come first.
  const std::string begin = lower(search_.text());
  std::ranges::stable_sort(list, [&](const EffectSchema* a, const EffectSchema* b) {
    return a->name.starts_with(begin) && !b->name.starts_with(begin);
  });

  std::optional<std::string> chosen;
  ImGui::SetNextWindowPos(at);
  ImGui::SetNextWindowSize(size);
  constexpr int kFlags = ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_NoSavedSettings;
  if (ImGui::Begin("Add an effect", &open_, kFlags)) {
    const SearchTurn turn = search_.draw(ui, "##effect", "Search effects; Up, Down, Enter");
    if (turn.go(chosen_, list.size())) scroll_ = true;
    const float foot = ImGui::GetFrameHeightWithSpacing();
    const float width = std::max(ui.px(170), ImGui::GetContentRegionAvail().x * 0.4f);
    ImGui::BeginChild("list", {width, -foot}, true);
    if (reading) ImGui::TextDisabled("Reading the effects…");
    if (!reading && list.empty()) ImGui::TextDisabled("No effect is called so");
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (ImGui::Selectable(list[i]->name.c_str(), i == chosen_, ImGuiSelectableFlags_AllowDoubleClick)) {
        chosen_ = i;
        search_.take_keyboard(ui);
        if (double_clicked()) chosen = list[i]->name;
      }
      if (i == chosen_ && std::exchange(scroll_, false)) ImGui::SetScrollHereY();
    }
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginChild("page", {0, -foot}, true);
    want_pictures(list);
    if (!list.empty()) draw_page(ui, *list[chosen_]);
    ImGui::EndChild();
    entered_ = entered_ || turn.entered;  // before the effects were read: they are waited for
    const bool enter = !reading && std::exchange(entered_, false);
    if (small_button(ui, "Add", "Enter", !list.empty()) || (enter && !list.empty())) chosen = list[chosen_]->name;
    if (turn.left) open_ = false;
    ImGui::SameLine();
    if (small_button(ui, "Cancel", "Esc")) open_ = false;
    ImGui::SameLine();
    ImGui::TextDisabled("%s", fmt::format("{} of {}", list.size(), library.effects().size()).c_str());
  }
  ImGui::End();
  if (chosen) open_ = false;
  return chosen;
}

/// As it is, the chosen one, and those that the arrows come to next.
void EffectBrowser::want_pictures(const std::vector<const EffectSchema*>& list) {
  constexpr std::size_t kNext = 4;
  if (!source_.want) return;
  std::vector<std::string> wanted{""};
  for (std::size_t i = chosen_; i < std::min(list.size(), chosen_ + kNext); ++i) wanted.push_back(list[i]->name);
  if (chosen_ > 0 && chosen_ <= list.size()) wanted.push_back(list[chosen_ - 1]->name);
  if (wanted == wanted_) return;
  wanted_ = wanted;
  source_.want(std::move(wanted));
}

/// The frame without and with it, side by side where there is room; why it does nothing there.
void EffectBrowser::draw_pictures(Ui& ui, const EffectSchema& effect) {
  if (!source_.find) return;
  const float gap = ui.px(6), most = (ImGui::GetContentRegionAvail().x - gap) / 2;
  const ImVec2 size{std::min(ui.px(Thumbnail::kWidth), most),
                    std::min(ui.px(Thumbnail::kWidth), most) * Thumbnail::kHeight / Thumbnail::kWidth};
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const auto with = source_.find(effect.name);
  constexpr int kCell = AtlasCells::kScopes + AtlasCells::kThumbnails;
  before_.draw(ui, kCell, source_.find(""), at, {at.x + size.x, at.y + size.y});
  const float x = at.x + size.x + gap;
  after_.draw(ui, kCell + 1, with, {x, at.y}, {x + size.x, at.y + size.y});
  ImGui::Dummy({2 * size.x + gap, size.y});
  if (!with || (!with->error && with->note.empty())) return;
  ImGui::PushStyleColor(ImGuiCol_Text, with->error ? ui_color::kError : ui_color::kWarning);
  ImGui::TextWrapped("%s",
                     (with->error ? "Error: " + with->error->text() : "Does nothing here: " + with->note).c_str());
  ImGui::PopStyleColor();
}

void EffectBrowser::draw_page(Ui& ui, const EffectSchema& effect) {
  ImGui::PushFont(ui.bold);
  ImGui::TextUnformatted(effect.name.c_str());
  ImGui::PopFont();
  ImGui::TextWrapped("%s", effect.doc.c_str());
  ImGui::PushStyleColor(ImGuiCol_Text, ui_color::kDim);
  ImGui::TextWrapped("Runs at %s, order %d", effect.at.c_str(), effect.order);
  ImGui::PopStyleColor();
  draw_pictures(ui, effect);
  ImGui::Separator();
  for (const SettingSchema& setting : effect.settings) {
    ImGui::TextUnformatted(setting.name.c_str());
    ImGui::SameLine();
    ImGui::TextDisabled("%s", setting.default_value.text().c_str());
    ImGui::PushStyleColor(ImGuiCol_Text, ui_color::kDim);
    ImGui::TextWrapped("%s", setting.doc.c_str());
    ImGui::PopStyleColor();
  }
}

}  // namespace afterglow
