// SPDX-License-Identifier: MIT
#include "window/setting_widget.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "image/srgb.h"

namespace afterglow {
namespace {

constexpr int kMaxInteger = 2147483647;
constexpr std::size_t kMostText = 1000;  // bytes, as scripts take them

// Digits that tell neighbouring values of the range apart.
const char* number_format(const SettingSchema& schema) {
  const double span = schema.min && schema.max ? *schema.max - *schema.min : 0;
  if (span > 200) return "%.1f";
  if (span > 20) return "%.2f";
  return "%.3f";
}

// A factor's digits are those that count; near zero the last decimal place says where the slider begins to be even.
const char* slider_format(const SettingSchema& schema) {
  return is_logarithmic(schema) && *schema.min >= 0 ? "%.4g" : number_format(schema);
}
ImGuiSliderFlags slider_flags(const SettingSchema& schema) {
  return is_logarithmic(schema) ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None;
}

// How far a pixel of a drag goes, where there is no range to slide in.
float drag_speed(double value) { return static_cast<float>(std::max(0.005, std::abs(value) * 0.01)); }

double held(const SettingSchema& schema, double value) {
  if (!std::isfinite(value)) return schema.default_value.number[0];
  if (schema.min) value = std::max(value, *schema.min);
  if (schema.max) value = std::min(value, *schema.max);
  return value;
}

// Dragged values are those that the row shows, so that presets get 0.176 and not 0.17600000053644177. Typed ones stay.
bool number_row(const char* name, const SettingSchema& schema, double& value) {
  if (schema.min && schema.max)
    return ImGui::SliderScalar(name, ImGuiDataType_Double, &value, &*schema.min, &*schema.max, slider_format(schema),
                               slider_flags(schema));
  return ImGui::DragScalar(name, ImGuiDataType_Double, &value, drag_speed(value), nullptr, nullptr, "%.3f");
}

bool integer_row(const char* name, const SettingSchema& schema, double& value) {
  const int least = static_cast<int>(std::max(schema.min.value_or(-kMaxInteger), -2147483647.0));
  const int most = static_cast<int>(std::min(schema.max.value_or(kMaxInteger), 2147483647.0));
  int number = static_cast<int>(value);
  const bool changed = schema.min && schema.max && std::int64_t{most} - least <= 1000
                           ? ImGui::SliderInt(name, &number, least, most)
                           : ImGui::DragInt(name, &number, 0.1f);
  value = std::clamp(number, least, most);
  return changed;
}

bool choice_row(const char* name, const SettingSchema& schema, std::string& choice) {
  bool changed = false;
  if (!ImGui::BeginCombo(name, choice.c_str())) return false;
  for (const auto& candidate : schema.choices) {
    const bool chosen = candidate == choice;
    if (ImGui::Selectable(candidate.c_str(), chosen) && !chosen) {
      choice = candidate;
      changed = true;
      break;
    }
    if (chosen) ImGui::SetItemDefaultFocus();
  }
  ImGui::EndCombo();
  return changed;
}

bool vector_row(const char* name, const SettingSchema& schema, std::array<double, 3>& number, int count) {
  if (schema.min && schema.max)
    return ImGui::SliderScalarN(name, ImGuiDataType_Double, number.data(), count, &*schema.min, &*schema.max,
                                slider_format(schema), slider_flags(schema));
  return ImGui::DragScalarN(name, ImGuiDataType_Double, number.data(), count, 0.01f, nullptr, nullptr, "%.3f");
}

// As screens show it: nothing is darker than black.
float color_code(double linear) { return static_cast<float>(linear_to_srgb(std::max(0.0, linear))); }

// Hue, saturation and value as the eye knows them, up to 1; what is brighter is that colour times a number of stops.
bool color_picker(const Ui& ui, std::array<double, 3>& number) {
  const double most = std::max({number[0], number[1], number[2], 1.0});
  std::array<float, 3> code{};
  for (std::size_t i = 0; i < 3; ++i) code[i] = color_code(number[i] / most);
  float stops = static_cast<float>(std::log2(most));
  ImGui::SetNextItemWidth(ui.px(220));
  bool changed = ImGui::ColorPicker3("##picker", code.data(),
                                     ImGuiColorEditFlags_NoSidePreview | ImGuiColorEditFlags_DisplayHex |
                                         ImGuiColorEditFlags_DisplayHSV | ImGuiColorEditFlags_PickerHueWheel);
  ImGui::SetNextItemWidth(ui.px(160));
  changed |= ImGui::SliderFloat("stops over 1", &stops, 0, 10, "%.2f", ImGuiSliderFlags_AlwaysClamp);
  if (changed)
    for (std::size_t i = 0; i < 3; ++i)
      number[i] = static_cast<float>(std::max(0.0, srgb_to_linear(code[i])) * std::exp2(stops));
  return changed;
}

bool color_row(const Ui& ui, const char* name, std::array<double, 3>& number, float width) {
  const double most = std::max({number[0], number[1], number[2], 1.0});
  const auto code = [&](std::size_t i) { return color_code(number[i] / most); };
  const float side = ImGui::GetFrameHeight();
  if (ImGui::ColorButton("##swatch", {code(0), code(1), code(2), 1}, ImGuiColorEditFlags_NoTooltip, {side, side}))
    ImGui::OpenPopup("color");
  bool changed = false;
  if (ImGui::BeginPopup("color")) {
    changed = color_picker(ui, number);
    ImGui::EndPopup();
  }
  ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
  ImGui::SetNextItemWidth(width - side - ImGui::GetStyle().ItemInnerSpacing.x);
  return ImGui::DragScalarN(name, ImGuiDataType_Double, number.data(), 3, 0.005f, nullptr, nullptr, "%.3f") || changed;
}

}  // namespace

bool is_logarithmic(const SettingSchema& schema) {
  const std::size_t count = number_count(schema.type);
  const bool real =
      schema.type == SettingType::number || schema.type == SettingType::vec2 || schema.type == SettingType::vec3;
  if (!real || !schema.min || !schema.max) return false;
  constexpr double kManyStops = 20;
  if (*schema.min < 0) return schema.unit == "EV" && *schema.max > 0 && *schema.max - *schema.min >= kManyStops;
  if (*schema.max > 100 && (*schema.min == 0 || *schema.max / *schema.min > 100)) return true;
  // What is usual would be a few pixels at one end.
  const auto& usual = schema.default_value.number;
  const double most = *std::max_element(usual.begin(), usual.begin() + static_cast<std::ptrdiff_t>(count));
  return *schema.min == 0 && most > 0 && most < *schema.max / 50;
}

std::optional<SettingValue> setting_widget(Ui& ui, const char* name, const SettingSchema& schema,
                                           const SettingValue& value, float width) {
  const ImGuiID item = ImGui::GetID(name);
  if (ui.typed.typing(item) || (ui.values_apply && ui.typed.opened(item, schema, value, width)))
    return ui.typed.draw(ui, name, schema, value, width);
  SettingValue out = value;
  bool changed = false;
  ImGui::SetNextItemWidth(width);
  switch (schema.type) {
    case SettingType::number:
      changed = number_row(name, schema, out.number[0]);
      break;
    case SettingType::integer:
      changed = integer_row(name, schema, out.number[0]);
      break;
    case SettingType::boolean: {
      bool on = out.number[0] != 0;
      changed = ImGui::Checkbox(name, &on);
      out.number[0] = on ? 1 : 0;
      break;
    }
    case SettingType::enumeration:
      changed = choice_row(name, schema, out.choice);
      break;
    case SettingType::file:
    case SettingType::text:
      if (auto text =
              ui.texts.draw(name, out.choice, schema.type == SettingType::text ? kMostText : TypedText::kMost)) {
        out.choice = std::move(*text);
        out.number[0] = 0;
        changed = true;
      }
      break;
    case SettingType::color:
      changed = color_row(ui, name, out.number, width);
      for (double& c : out.number) c = std::isfinite(c) ? std::max(c, 0.0) : 0;
      break;
    case SettingType::vec2:
    case SettingType::vec3:
      changed = vector_row(name, schema, out.number, schema.type == SettingType::vec2 ? 2 : 3);
      break;
  }
  ui.typed.note_press(item, value);
  // What is dragged beyond the ends stays within them.
  const bool ranged =
      schema.type == SettingType::number || schema.type == SettingType::vec2 || schema.type == SettingType::vec3;
  if (ranged)
    for (double& c : out.number) c = held(schema, c);
  if (schema.type == SettingType::number) out.number[1] = out.number[2] = 0;
  if (schema.type == SettingType::vec2) out.number[2] = 0;
  return changed && !(out == value) ? std::optional(out) : std::nullopt;
}

}  // namespace afterglow
