// SPDX-License-Identifier: MIT
#include "window/frame_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parse_number.h"
#include "core/text.h"
#include "window/sheet.h"

namespace afterglow {
namespace {

/// Frames of a timecode a second: 24 of 23.976.
int frames_a_second(double fps) { return std::max(1, static_cast<int>(std::lround(fps))); }

std::optional<int> position_of_timecode(const std::string& text, double fps) {
  const auto parts = split(text, ':');
  if (parts.size() < 2 || parts.size() > 4) return std::nullopt;
  long long seconds = 0, frames = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto part = parse_number<int>(parts[i]);
    if (!part || *part < 0 || *part > 1'000'000) return std::nullopt;
    if (i + 1 == parts.size()) {
      frames = *part;
    } else {
      seconds = seconds * 60 + *part;
    }
  }
  return static_cast<int>(std::min(seconds * frames_a_second(fps) + frames, 2'000'000'000LL));
}

}  // namespace

std::optional<int> position_named(const std::string& text, const FrameRow& row) {
  const std::string word = trim(text);
  if (word.empty() || row.frames < 1) return std::nullopt;
  const auto held = [&](long long at) { return static_cast<int>(std::clamp<long long>(at, 0, row.frames - 1)); };
  if (word.find(':') != std::string::npos) {
    const auto at = position_of_timecode(word, row.fps);
    return at ? std::optional(held(*at)) : std::nullopt;
  }
  if (word[0] == '+' || word[0] == '-') {
    const auto by = parse_number<int>(std::string_view(word).substr(word[0] == '+' ? 1 : 0));
    return by ? std::optional(held(static_cast<long long>(row.position) + *by)) : std::nullopt;
  }
  const auto wanted = parse_number<int>(word);
  if (!wanted) return std::nullopt;
  const int clip_end = row.clip_first + row.clip_frames;
  for (const auto& [begin, end] : {std::pair(row.clip_first, clip_end), std::pair(0, row.frames)})
    for (int i = begin; i < end; ++i)
      if (row.number(i) == *wanted) return i;
  for (int i = row.clip_first; i < clip_end; ++i)
    if (row.number(i) > *wanted) return i;
  return clip_end - 1;
}

std::string timecode_text(int position, double fps) {
  const int rate = frames_a_second(fps), seconds = position / rate;
  return fmt::format("{:02}:{:02}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60, position % rate);
}

std::optional<std::string> draw_frame_field(Ui& ui, ImVec2 middle) {
  begin_sheet("frame field", middle, {0.5f, 0.5f}, ui, 0);
  ImGui::TextUnformatted("Go to frame");
  if (std::exchange(ui.frame_field.begin, false)) focus_next_item();
  ImGui::SetNextItemWidth(ui.px(180));
  auto& text = ui.frame_field.text;
  const bool entered = ImGui::InputTextWithHint("##frame", "1001, +12, 00:01:12", text.data(), text.size(),
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  const bool left = ImGui::IsItemDeactivated();
  end_sheet();
  if (!entered && !left) return std::nullopt;
  ui.show_frame_field = false;
  return entered ? std::string(text.data()) : std::string();
}

}  // namespace afterglow
