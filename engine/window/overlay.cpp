// SPDX-License-Identifier: MIT
#include "window/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "window/sheet.h"
#include "window/view_pass.h"

namespace afterglow {

namespace {

constexpr float kProbeWidth = 390, kLeastForColumn = 180;  // that values across and down need

void wrapped(ImU32 color, const std::string& text, float width) {
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::PushTextWrapPos(width);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

/// The error that counts most: one of the preset hides what its last good stack makes of the picture.
struct Message {
  std::string headline, where, what, line, allowed, nearest, full;
  ErrorPlace place;
  std::vector<ErrorLine> further;
  std::vector<ErrorPlace> places;
};

Message message_of(std::string headline, const Error& error, const std::string& line, std::string full) {
  Message out;
  out.headline = std::move(headline);
  out.where = error.line > 0 ? fmt::format("{}:{}", error.file, error.line) : error.file;
  out.what = error.message;
  out.place = {error.file, error.line};
  out.line = line;
  out.allowed = error.allowed;
  out.nearest = error.nearest;
  out.full = std::move(full);
  out.further = further_lines(error);
  out.places = error_places(error);
  return out;
}

/// The first pass that is to blame; the others behind it.
Error error_of(const FiniteAnswer& answer) {
  if (answer.passes.empty()) return {ErrorKind::script, kUntraced};
  const PassFinding& first = answer.passes.front();
  Error out{ErrorKind::script, fmt::format("{}, in {}", finding_text(first), answer.name), first.file, first.line};
  for (std::size_t i = 1; i < answer.passes.size(); ++i) {
    const PassFinding& finding = answer.passes[i];
    out.trail.push_back(finding.file.empty()
                            ? finding_text(finding)
                            : fmt::format("{}:{}: {}", finding.file, finding.line, finding_text(finding)));
  }
  return out;
}

std::optional<Message> current(const Player& constant) {
  Player& player = const_cast<Player&>(constant);
  const LiveStatus status = player.live().status();
  if (status.error) {
    return message_of(
        status.generation > 0 ? "The preset has an error; this is the last good version" : "The preset has an error",
        *status.error, status.source_line, status.error_text());
  }
  const ShownFrame& shown = player.shown();
  if (shown.unreadable) {
    return message_of("A picture cannot be read", *shown.unreadable, "", shown.unreadable->text());
  }
  if (LiveStack* other = player.other()) {
    const LiveStatus of_other = other->status();
    if (of_other.error)
      return message_of(of_other.generation > 0
                            ? "The other preset has an error; its last good version is compared with"
                            : "The other preset has an error; there is nothing of it to compare with",
                        *of_other.error, of_other.source_line, of_other.error_text());
  }
  if (shown.failed) return message_of("The stack cannot be run", *shown.failed, "", shown.failed->text());
  if (shown.not_finite) {
    const Error error = error_of(*shown.not_finite);
    return message_of("A pass makes values that are not finite; they are shown as 0", error, "", error.text());
  }
  return std::nullopt;
}

}  // namespace

std::string comparison_text(Player& player) {
  const View& view = player.view();
  if (view.compare == Compare::none) return "result";
  if (view.compare == Compare::source) {
    if (view.by == CompareBy::flip) return "before";
    return view.by == CompareBy::difference ? "difference from what went in" : "before | after";
  }
  const std::filesystem::path &own = player.preset_file(), &other = player.other_file();
  const bool alike = own.filename() == other.filename();
  const auto name = [&](const std::filesystem::path& file) {
    std::error_code ec;  // the folder of the call may be gone
    return alike ? (absolute(file, ec).parent_path().filename() / file.filename()).string() : file.filename().string();
  };
  if (view.by == CompareBy::flip) return "B: " + name(other);
  if (view.by == CompareBy::difference) return "difference from " + name(other);
  return name(other) + " | " + name(own);
}

std::string current_message(const Player& player) {
  const auto message = current(player);
  return message ? message->full : "";
}

std::vector<ErrorPlace> current_places(const Player& player) {
  const auto message = current(player);
  if (message && !message->places.empty()) return message->places;
  return {ErrorPlace{player.preset_file(), 0}};
}

namespace {

/// A shader's further errors, each with its place; a click opens it.
void draw_further(const std::vector<ErrorLine>& lines, Ui& ui, float wrap) {
  if (lines.empty()) return;
  ImGui::Separator();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const ErrorLine& line = lines[i];
    ImGui::BeginGroup();
    if (!line.where.empty()) wrapped(ui_color::kError, line.where, wrap);
    wrapped(line.where.empty() ? ui_color::kDim : ui_color::kText, line.what, wrap);
    ImGui::EndGroup();
    if (line.place.file.empty()) continue;
    ui.help("A click opens it in the editor (F4 again: the next one)");
    if (!ImGui::IsItemHovered() || !ImGui::IsMouseClicked(ImGuiMouseButton_Left)) continue;
    ui.edit_file(line.place.file.string(), line.place.line);
    ui.again();
  }
}

}  // namespace

void draw_error_overlay(Player& player, Ui& ui, const OverlayArea& area) {
  const auto message = current(player);
  if (!message) return;
  const float margin = ui.px(14), width = std::min(area.size.x - 2 * margin, ui.px(900));
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, area.size.y * 0.6f});
  begin_sheet("error", {area.at.x + margin, area.at.y + area.size.y - margin}, {0, 1}, ui, 0);
  const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  ImGui::PushClipRect(at, {at.x + size.x, at.y + size.y}, false);  // over the sheet's padding
  ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + ui.px(4), at.y + size.y}, ui_color::kError, ui.px(5),
                                            ImDrawFlags_RoundCornersLeft);
  ImGui::PopClipRect();
  ImGui::Indent(ui.px(6));
  const float wrap = width - ui.px(16);
  const auto shader_errors =
      std::ranges::count_if(message->further, [](const ErrorLine& e) { return !e.where.empty(); });
  const std::string headline =
      message->headline + (shader_errors > 0 ? fmt::format(" ({} errors)", shader_errors + 1) : "");
  const bool beside = ImGui::CalcTextSize(headline.c_str()).x + ui.px(140) < width;  // the buttons have room there
  wrapped(ui_color::kDim, headline, wrap);
  if (beside) ImGui::SameLine(width - ui.px(120));
  if (!message->place.file.empty() && ImGui::SmallButton("Open")) {
    ui.edit_file(message->place.file.string(), message->place.line);
    ui.again();
  }
  ui.help("In the editor that AFTERGLOW_EDITOR names (F4; again: the next error)");
  ImGui::SameLine(beside ? width - ui.px(70) : 0);
  if (ImGui::SmallButton("Copy")) {
    ui.copy(message->full);
    ui.say("message copied");
    ui.again();
  }
  if (!message->where.empty()) {
    ImGui::PushFont(ui.bold);
    wrapped(ui_color::kError, message->where, wrap);
    ImGui::PopFont();
  }
  wrapped(ui_color::kText, message->what, wrap);
  if (!message->line.empty()) {
    ImGui::PushFont(ui.mono);
    wrapped(ui_color::kWarning, "    " + message->line, wrap);
    ImGui::PopFont();
  }
  if (!message->nearest.empty()) wrapped(ui_color::kGood, fmt::format("did you mean '{}'?", message->nearest), wrap);
  if (!message->allowed.empty()) wrapped(ui_color::kDim, "allowed: " + message->allowed, wrap);
  draw_further(message->further, ui, wrap);
  end_sheet();
}

namespace {

/// What marks mean, each by its colour and in words.
void draw_legend(Marks marks) {
  if (marks == Marks::none) return;
  const auto entry = [](const ViewColor& c, const std::string& text) {
    const float side = ImGui::GetTextLineHeight() * 0.7f;
    ImGui::ColorButton(text.c_str(), {c[0], c[1], c[2], 1}, ImGuiColorEditFlags_NoTooltip, {side, side});
    ImGui::SameLine();
    ImGui::TextUnformatted(text.c_str());
  };
  if (marks == Marks::range) {
    entry(kMarkBelow, "below 0: outside Rec.709");
    entry(kMarkAbove, "above 1: clipped");
  } else {
    for (int zone = kLastZone; zone >= kFirstZone; --zone) {
      const char* more = zone == kLastZone ? " EV and more" : zone == kFirstZone ? " EV and less" : " EV";
      entry(kZones[static_cast<std::size_t>(zone - kFirstZone)],
            zone == 0 ? "0 EV: 0.18, middle grey" : fmt::format("{:+d}{}", zone, more));
    }
  }
  entry(kMarkNotFinite, "not finite");
}

}  // namespace

void draw_state_overlay(Player& player, const Ui& ui, const OverlayArea& area) {
  const View& view = player.view();
  std::vector<std::pair<ImU32, std::string>> lines;
  if (const std::string& image = player.live().shown(); !image.empty()) {
    const std::vector<std::string> images = player.live().images();
    const bool there = images.empty() || std::ranges::find(images, image) != images.end();
    lines.emplace_back(there ? ui_color::kAccent : ui_color::kWarning,
                       there ? "image: " + image : "no image " + image + ": the result");
  }
  if (player.proxy() > 1) lines.emplace_back(ui_color::kAccent, "proxy " + proxy_name(player.proxy()));
  if (!ui.display.empty())
    lines.emplace_back(ui_color::kText, view.as_display ? "view: " + ui.display : "view: sRGB, not " + ui.display);
  if (view.channel != ViewChannel::color) lines.emplace_back(ui_color::kText, view_channel_name(view.channel));
  if (view.gamma != 1) lines.emplace_back(ui_color::kText, fmt::format("view gamma {:.2f}", view.gamma));
  if (view.exposure != 0) lines.emplace_back(ui_color::kText, fmt::format("view {:+.2f} EV", view.exposure));
  if (view.compare != Compare::none) lines.emplace_back(ui_color::kText, comparison_text(player));
  const bool building = player.live().status().building;
  if (lines.empty() && view.marks == Marks::none && !building) return;

  begin_sheet("state", {area.at.x + ui.px(14), area.at.y + ui.px(14)}, {0, 0}, ui, ImGuiWindowFlags_NoInputs);
  ImGui::PushTextWrapPos(sheet_wrap(ui, area.size.x));
  for (const auto& [color, text] : lines) colored(color, text);
  draw_legend(view.marks);
  if (building) colored(ui_color::kAccent, "building …");
  ImGui::PopTextWrapPos();
  end_sheet();
}

namespace {

using Values = std::array<float, 4>;

constexpr ImU32 kChannelColors[] = {IM_COL32(255, 128, 120, 255), IM_COL32(130, 220, 130, 255),
                                    IM_COL32(130, 170, 255, 255), ui_color::kDim};

/// A line for each picture.
void draw_values_across(const std::vector<std::pair<const char*, Values>>& pictures) {
  for (const auto& [name, c] : pictures) {
    colored(ui_color::kDim, fmt::format("{:7}", name));
    for (std::size_t i = 0; i < c.size(); ++i) {
      ImGui::SameLine();
      colored(kChannelColors[i], fmt::format("{:>10.5g}", c[i]));
    }
  }
}

/// A column for each picture: half as wide.
void draw_values_down(const std::vector<std::pair<const char*, Values>>& pictures) {
  std::string names = " ";
  for (const auto& picture : pictures) names += fmt::format(" {:>8}", picture.first);
  colored(ui_color::kDim, names);
  for (std::size_t i = 0; i < 4; ++i) {
    std::string line(1, "RGBA"[i]);
    for (const auto& picture : pictures) line += fmt::format(" {:>8.4g}", picture.second[i]);
    colored(kChannelColors[i], line);
  }
}

}  // namespace

void draw_probe_overlay(const Probe& probe, const View& view, const Ui& ui, const OverlayArea& area) {
  const bool wide = area.size.x >= ui.px(kProbeWidth);
  const float left = area.at.x + ui.px(14), bottom = area.at.y + area.size.y - ui.px(14);
  const auto room = ui.sheets.free(left, left + ui.px(180), {area.at.y, bottom});
  // Nothing else would be left to see.
  if (!wide && (view.scope != ScopeKind::none || room.bottom - room.top < ui.px(kLeastForColumn))) return;
  begin_sheet("probe", {left, bottom}, {0, 1}, ui, ImGuiWindowFlags_NoInputs);
  ImGui::PushFont(ui.mono);
  std::vector<std::pair<const char*, Values>> pictures{{"source", probe.source}, {"result", probe.result}};
  if (probe.other) pictures.emplace_back("other", *probe.other);
  colored(ui_color::kText, fmt::format("{}, {}", probe.pixel.x, probe.pixel.y));
  if (wide) {
    draw_values_across(pictures);
  } else {
    draw_values_down(pictures);
  }
  ImGui::PopFont();
  end_sheet();
}

void draw_message_overlay(const Ui& ui, const OverlayArea& area) {
  if (ui.message.empty() || ui.now >= ui.message_until) return;
  begin_sheet("message", {area.at.x + area.size.x / 2, area.at.y + ui.px(14)}, {0.5f, 0}, ui,
              ImGuiWindowFlags_NoInputs);
  ImGui::PushTextWrapPos(sheet_wrap(ui, area.size.x));
  ImGui::TextUnformatted(ui.message.c_str());
  ImGui::PopTextWrapPos();
  end_sheet();
}

}  // namespace afterglow
