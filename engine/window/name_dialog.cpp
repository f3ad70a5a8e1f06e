// SPDX-License-Identifier: MIT
#include "window/name_dialog.h"

#include <fmt/format.h>

#include <algorithm>
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

void NameDialog::open(Question question) {
  question_ = std::move(question);
  open_ = begin_ = true;
  asked_.clear();
  text_.fill(0);
  question_.name.copy(text_.data(), text_.size() - 1);
}

std::optional<std::string> NameDialog::draw(Ui& ui, ImVec2 area) {
  if (!open_) return std::nullopt;
  ImGui::SetNextWindowPos({area.x / 2, area.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  constexpr int kFlags = ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings;
  std::optional<std::string> chosen;
  if (ImGui::Begin((question_.title + "###name").c_str(), &open_, kFlags)) {
    const float width = std::min(ui.px(420), area.x * 0.9f);
    if (std::exchange(begin_, false)) focus_next_item();
    ImGui::SetNextItemWidth(width);
    const bool entered = ImGui::InputText("##file", text_.data(), text_.size(),
                                          ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    const bool lost = ImGui::IsItemDeactivated() && !entered && !ImGui::IsMouseClicked(ImGuiMouseButton_Left);
    const bool left = lost && escape_pressed();
    if (lost && !left) begin_ = ui.field_opens = true;  // by no wish of the user: it goes on
    const bool asks = !asked_.empty();
    const std::string note = asks ? fmt::format("{} exists: Enter again replaces it", over_) : question_.note;
    ImGui::PushTextWrapPos(width);
    ImGui::PushStyleColor(ImGuiCol_Text, asks ? ui_color::kWarning : ui_color::kDim);
    ImGui::TextUnformatted(note.c_str());
    ImGui::PopStyleColor();
    ImGui::PopTextWrapPos();
    const bool pressed = ImGui::Button((question_.button + " (Enter)###do").c_str());
    ImGui::SameLine();
    if (ImGui::Button("Go back (Esc)") || left) open_ = false;
    const std::string name = trim(text_.data());
    if ((entered || pressed) && (question_.may_be_empty || !name.empty())) {
      const auto over = question_.in_the_way ? question_.in_the_way(name) : std::nullopt;
      if (over && name != asked_) {
        asked_ = name;
        over_ = *over;
        begin_ = ui.field_opens = true;  // the field keeps the keyboard
        ui.again();
      } else {
        chosen = name;
        open_ = false;
      }
    }
  }
  ImGui::End();
  return chosen;
}

}  // namespace afterglow
