// SPDX-License-Identifier: MIT
#include "window/typed_text.h"

#include <imgui_internal.h>

#include <algorithm>

namespace afterglow {

std::optional<std::string> TypedText::draw(const char* name, const std::string& value, std::size_t most) {
  const ImGuiID item = ImGui::GetID(name);
  const auto field = std::ranges::find(fields_, item, &Field::item);
  const bool open = field != fields_.end();
  Field shown{item, {}, value};
  value.copy(shown.text.data(), kMost);
  auto& text = open ? field->text : shown.text;
  // Tab takes the text as Enter does, and goes to no other field: keys are shortcuts again.
  bool tab = false;
  const auto on_tab = [](ImGuiInputTextCallbackData* data) {
    *static_cast<bool*>(data->UserData) = true;
    return 0;
  };
  const bool entered =
      ImGui::InputText(name, text.data(), std::min(most, kMost) + 1,
                       ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackCompletion, on_tab, &tab);
  if (tab) ImGui::ClearActiveID();
  const bool active = ImGui::IsItemActive() && !entered;
  if (!open && active) fields_.push_back(shown);
  if (!open || active) return std::nullopt;
  std::string out = text.data();
  const bool same = out == value || out == field->opened_with;
  fields_.erase(field);
  return same ? std::nullopt : std::optional(std::move(out));
}

}  // namespace afterglow
