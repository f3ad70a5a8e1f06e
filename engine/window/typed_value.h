// SPDX-License-Identifier: MIT
// A value that is typed in place of its slider: a double click (or Ctrl+click) on the slider opens a field; Enter, Tab
// and a click elsewhere take what stands in it, Escape leaves the value as it was.
#pragma once

#include <imgui.h>

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "script/schema.h"

namespace afterglow {

struct Ui;

/// One at a time. Drawing thread alone.
class TypedValue {
 public:
  /// A field was opened, and has not got the keyboard yet.
  bool opening() const { return item_ != 0 && !active_; }
  /// Whether this item (ImGui::GetID) is a field now.
  bool typing(ImGuiID item) const { return item == item_; }
  /// Before the slider is drawn at the cursor, that wide: opens the field where the mouse asks for it.
  bool opened(ImGuiID item, const SettingSchema& schema, const SettingValue& value, float width);
  /// In the slider's place. A value once one was entered.
  std::optional<SettingValue> draw(Ui& ui, const char* name, const SettingSchema& schema, const SettingValue& value,
                                   float width);
  /// After the slider was drawn with `value`: remembers it, because the first click of two moves the slider.
  void note_press(ImGuiID item, const SettingValue& value);
  /// Once: the click that opened the field had changed the value.
  bool take_back() { return std::exchange(take_back_, false); }

 private:
  ImGuiID item_ = 0, pressed_ = 0;
  SettingValue before_;  ///< of the item that was pressed last
  bool begin_ = false, take_back_ = false, active_ = false;
  int idle_ = 0;  ///< frames without the keyboard
  std::array<char, 128> text_{};
  std::string opened_with_;  ///< what stood in the field then: the value may be another one since
};

/// As many numbers as the type has, separated by blanks or commas. None: it is not that.
std::optional<SettingValue> parse_typed(const SettingSchema& schema, const std::string& text);
/// The same the other way, with all digits.
std::string typed_text(const SettingSchema& schema, const SettingValue& value);

}  // namespace afterglow
