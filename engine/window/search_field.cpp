// SPDX-License-Identifier: MIT
#include "window/search_field.h"

#include <algorithm>
#include <string>
#include <utility>

namespace afterglow {

bool SearchTurn::go(std::size_t& chosen, std::size_t count) const {
  if (changed) chosen = 0;
  const bool goes = step != 0 && count > 0;
  if (goes && step < 0) chosen = chosen > 0 ? chosen - 1 : 0;
  if (goes && step > 0) ++chosen;
  chosen = std::min(chosen, count == 0 ? 0 : count - 1);
  return changed || goes;
}

SearchTurn SearchField::draw(Ui& ui, const char* name, const char* hint) {
  if (std::exchange(begin_, false)) focus_next_item();
  ImGui::SetNextItemWidth(-1);
  const std::string before = text_.data();
  SearchTurn turn;
  const auto on_arrow = [](ImGuiInputTextCallbackData* data) {
    *static_cast<int*>(data->UserData) = data->EventKey == ImGuiKey_UpArrow ? -1 : 1;
    return 0;
  };
  turn.entered = ImGui::InputTextWithHint(name, hint, text_.data(), text_.size(),
                                          ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackHistory,
                                          on_arrow, &turn.step);
  turn.changed = before != text_.data();
  const bool lost = ImGui::IsItemDeactivated() && !turn.entered && !ImGui::IsMouseClicked(ImGuiMouseButton_Left);
  turn.left = lost && escape_pressed();
  if (lost && !turn.left) take_keyboard(ui);  // by no wish of the user: it goes on
  return turn;
}

}  // namespace afterglow
