// SPDX-License-Identifier: MIT
#include "window/typed_value.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parse_number.h"
#include "core/text.h"
#include "window/ui.h"

namespace afterglow {
std::optional<SettingValue> parse_typed(const SettingSchema& schema, const std::string& text) {
  std::string spaced = text;
  std::ranges::replace(spaced, ',', ' ');
  std::vector<double> numbers;
  for (const auto& word : split(spaced, ' ')) {
    if (word.empty()) continue;
    const auto number = parse_number<double>(std::string_view(word).substr(word[0] == '+' ? 1 : 0));
    if (!number || !std::isfinite(*number)) return std::nullopt;
    numbers.push_back(*number);
  }
  const std::size_t count = number_count(schema.type);
  // One number for all of them: grey.
  if (numbers.size() == 1 && count > 1) numbers.assign(count, numbers[0]);
  if (numbers.size() != count || count == 0) return std::nullopt;
  SettingValue out{schema.type, {}, ""};
  for (std::size_t i = 0; i < count; ++i) {
    double value = numbers[i];
    if (schema.min) value = std::max(value, *schema.min);
    if (schema.max) value = std::min(value, *schema.max);
    out.number[i] = schema.type == SettingType::integer ? std::round(value) : value;
  }
  return out;
}

std::string typed_text(const SettingSchema& schema, const SettingValue& value) {
  std::string out;
  for (std::size_t i = 0; i < number_count(schema.type); ++i) out += (i > 0 ? " " : "") + number_text(value.number[i]);
  return out;
}

bool TypedValue::opened(ImGuiID item, const SettingSchema& schema, const SettingValue& value, float width) {
  if (number_count(schema.type) == 0 || !ImGui::IsWindowHovered()) return false;
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float swatch = schema.type == SettingType::color ? ImGui::GetFrameHeight() : 0;
  if (!ImGui::IsMouseHoveringRect({from.x + swatch, from.y}, {from.x + width, from.y + ImGui::GetFrameHeight()}))
    return false;
  const bool twice = double_clicked();
  const bool control = ImGui::IsMouseClicked(ImGuiMouseButton_Left) && ImGui::GetIO().KeyCtrl;
  if (!twice && !control) return false;
  take_back_ = twice && pressed_ == item && !(before_ == value);
  const std::string text = typed_text(schema, take_back_ ? before_ : value);
  text_.fill(0);
  text.copy(text_.data(), text_.size() - 1);
  opened_with_ = text_.data();
  item_ = item;
  begin_ = true;
  active_ = false;
  idle_ = 0;
  return true;
}

std::optional<SettingValue> TypedValue::draw(Ui& ui, const char* name, const SettingSchema& schema,
                                             const SettingValue& value, float width) {
  constexpr int kPatience = 4;
  if (std::exchange(begin_, false)) focus_next_item();
  ImGui::SetNextItemWidth(width);
  // Tab takes the value as Enter does, and goes to no other field: keys are shortcuts again.
  bool tab = false;
  const auto on_tab = [](ImGuiInputTextCallbackData* data) {
    *static_cast<bool*>(data->UserData) = true;
    return 0;
  };
  bool entered = ImGui::InputText(
      name, text_.data(), text_.size(),
      ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll | ImGuiInputTextFlags_CallbackCompletion,
      on_tab, &tab);
  if (tab) ImGui::ClearActiveID();
  entered = entered || tab;
  const bool left = ImGui::IsItemDeactivated();
  idle_ = ImGui::IsItemActive() ? 0 : idle_ + 1;
  active_ = active_ || ImGui::IsItemActive();
  if (!entered && !left && idle_ < kPatience) return std::nullopt;
  item_ = 0;
  if (!entered && !left) return std::nullopt;
  if (opened_with_ == text_.data()) return std::nullopt;
  const auto typed = parse_typed(schema, text_.data());
  if (!typed) {
    ui.say(std::string("'") + text_.data() + "' is no value of this setting");
    return std::nullopt;
  }
  return typed_text(schema, *typed) == typed_text(schema, value) ? std::nullopt : typed;
}

void TypedValue::note_press(ImGuiID item, const SettingValue& value) {
  if (!ImGui::IsItemActivated()) return;
  pressed_ = item;
  before_ = value;
}

}  // namespace afterglow
