// SPDX-License-Identifier: MIT
#include "window/save_as.h"

#include <fmt/format.h>

#include <utility>

#include "core/text.h"

namespace afterglow {
namespace fs = std::filesystem;

fs::path free_name(const fs::path& preset) {
  std::string stem = preset.stem().string();
  const std::size_t digits = stem.find_last_not_of("0123456789");
  if (digits != std::string::npos && stem[digits] == '_' && digits + 1 < stem.size()) stem.resize(digits);
  std::error_code none;
  for (int n = 2;; ++n) {
    const fs::path file = preset.parent_path() / fmt::format("{}_{}.lua", stem, n);
    if (!fs::exists(file, none)) return file;
  }
}

void SaveAs::open(const fs::path& preset) {
  open_ = begin_ = true;
  folder_ = preset.parent_path();
  asked_.clear();
  text_.fill(0);
  free_name(preset).filename().string().copy(text_.data(), text_.size() - 1);
}

std::optional<fs::path> SaveAs::draw(Ui& ui, ImVec2 area) {
  if (!open_) return std::nullopt;
  ImGui::SetNextWindowPos({area.x / 2, area.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  constexpr int kFlags = ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings;
  std::optional<fs::path> chosen;
  if (ImGui::Begin("Save preset as", &open_, kFlags)) {
    const float width = std::min(ui.px(420), area.x * 0.9f);
    if (std::exchange(begin_, false)) focus_next_item();
    ImGui::SetNextItemWidth(width);
    const bool entered = ImGui::InputText("##file", text_.data(), text_.size(),
                                          ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    const bool left = ImGui::IsItemDeactivated() && !entered && !ImGui::IsMouseClicked(ImGuiMouseButton_Left);
    ImGui::PushTextWrapPos(width);
    if (asked_.empty()) {
      ImGui::TextDisabled("In %s", folder_.empty() ? "the current folder" : folder_.string().c_str());
    } else {
      ImGui::PushStyleColor(ImGuiCol_Text, ui_color::kWarning);
      ImGui::TextWrapped("%s exists: Enter again replaces it", asked_.filename().string().c_str());
      ImGui::PopStyleColor();
    }
    ImGui::PopTextWrapPos();
    const bool pressed = ImGui::Button("Save (Enter)");
    ImGui::SameLine();
    if (ImGui::Button("Go back (Esc)") || left) open_ = false;
    const std::string name = trim(text_.data());
    if ((entered || pressed) && !name.empty()) {
      fs::path file = folder_ / name;
      if (file.extension().empty()) file += ".lua";
      std::error_code none;
      if (fs::exists(file, none) && file != asked_) {
        asked_ = file;
        begin_ = ui.field_opens = true;  // the field keeps the keyboard
        ui.again();
      } else {
        chosen = file;
        open_ = false;
      }
    }
  }
  ImGui::End();
  return chosen;
}

}  // namespace afterglow
