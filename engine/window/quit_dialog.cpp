// SPDX-License-Identifier: MIT
#include "window/quit_dialog.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace afterglow {

namespace {

std::string lost(const QuitQuestion& question) {
  const std::string rest = question.exporting.empty() ? "" : "the rest of an export (" + question.exporting + ")";
  return question.changes + (question.changes.empty() || rest.empty() ? "" : " and ") + rest + " would be lost.";
}

}  // namespace

std::optional<QuitAnswer> draw_quit_dialog(const Ui& ui, const QuitQuestion& question, ImVec2 area) {
  const bool saves = !question.changes.empty(), finishes = !question.exporting.empty();
  const std::string wish = saves && finishes ? "Save and finish the export" : saves ? "Save" : "Finish the export";
  ImGui::GetBackgroundDrawList()->AddRectFilled({0, 0}, area, IM_COL32(0, 0, 0, 128));
  ImGui::SetNextWindowPos({area.x / 2, area.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowFocus();
  constexpr int kFlags = ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings;
  std::optional<QuitAnswer> answer;
  if (ImGui::Begin((wish + " before " + question.before + "?###quit").c_str(), nullptr, kFlags)) {
    ImGui::PushTextWrapPos(ui.px(420));
    ImGui::TextUnformatted(lost(question).c_str());
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
    if (ImGui::Button(saves && finishes ? "Save and finish (S)" : saves ? "Save (S)" : "Finish (S)"))
      answer = QuitAnswer::save;
    ImGui::SameLine();
    if (ImGui::Button("Discard (D)")) answer = QuitAnswer::discard;
    ImGui::SameLine();
    if (ImGui::Button("Go on (Esc)")) answer = QuitAnswer::cancel;
  }
  ImGui::End();
  return answer;
}

std::optional<QuitAnswer> quit_answer_of(int key) {
  switch (key) {
    case GLFW_KEY_S:
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER:
      return QuitAnswer::save;
    case GLFW_KEY_D:
      return QuitAnswer::discard;
    case GLFW_KEY_ESCAPE:
      return QuitAnswer::cancel;
    default:
      return std::nullopt;
  }
}

}  // namespace afterglow
