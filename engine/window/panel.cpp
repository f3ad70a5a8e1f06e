// SPDX-License-Identifier: MIT
#include "window/panel.h"

#include <fmt/format.h>

#include <algorithm>

#include "script/build.h"
#include "window/kept_preset.h"
#include "window/panel_row.h"
#include "window/view_controls.h"

namespace afterglow {
bool Panel::save(PanelPort& port) {
  if ((stack_.busy() || !unsaved(port).empty()) && !keeper_of(save_.file()).empty()) {
    save_as();
    return true;
  }
  save_waits_ = stack_.busy();
  if (!save_waits_) save_.save(port, bases_);
  return false;
}

/// What goes wrong stands over the panel's end.
void Panel::undo_save(Ui& ui, PanelPort& port) {
  save_.undo(port, bases_);
  if (!save_.failed()) ui.say(save_.message());
}

namespace {

std::string name_of(const SettingEdit& edit) {
  return edit.entry.empty() ? edit.setting : edit.entry + "." + edit.setting;
}

/// Is the error about what was changed? It says the setting, the value, or the file that the value names.
bool names(const Error& error, const SettingEdit& edit) {
  const auto says = [&](const std::string& text) { return error.message.find(text) != std::string::npos; };
  const bool its_file =
      edit.value.type == SettingType::file && !edit.value.choice.empty() && error.file.ends_with(edit.value.choice);
  return says(name_of(edit)) || says(fmt::format("{} = {}", edit.setting, edit.value.text())) || its_file;
}

/// A preset's name ends in ".lua", whatever dots it has.
std::filesystem::path copy_of(const std::filesystem::path& preset, const std::string& name) {
  std::filesystem::path file = folder_for_copies(preset) / name;
  if (file.extension() != ".lua") file += ".lua";
  return file;
}

}  // namespace

std::string Panel::unsaved(PanelPort& port) const {
  const auto& edits = port.edits().edits();
  const auto count = std::ranges::count_if(
      edits, [&](const SettingEdit& edit) { return !edit.entry.empty() && !save_.settles(edit); });
  const bool stack = port.edits().stack_text() != nullptr;
  if (count == 0 && !stack) return {};
  const std::string settings = count == 1 ? "1 setting" : fmt::format("{} settings", count);
  const std::string what = !stack ? settings : count == 0 ? "the stack" : "the stack and " + settings;
  return fmt::format("{} of {}", what, save_.file().filename().string());
}

void Panel::turn(Ui& ui, PanelPort& port) {
  if (save_.poll(port, bases_)) ui.say(save_.message());
  if (const auto copy = save_.take_copy()) ui.open(copy->string());
  if (stack_.poll(port, !save_.busy())) {
    ui.say(stack_.message());
    chosen_ = !stack_.failed() ? stack_.called_now(chosen_) : removed_.empty() ? chosen_ : removed_;
    removed_.clear();
    if (act_due_) act_due_->entry = stack_.called_now(act_due_->entry);
  }
  const bool told = std::exchange(conflict_told_, stack_.conflict());
  if (stack_.conflict() && !told) ui.say(conflict_text());
  // What was asked for before is part of what is saved.
  if (save_waits_ && !stack_.busy()) {
    save_waits_ = false;
    save_.save(port, bases_);
  }
  if (copy_due_ && !save_.busy()) save_.save_as(port, *std::exchange(copy_due_, std::nullopt));
  if (const std::string shown = stack_.take_shown(); !shown.empty()) {
    chosen_ = shown;
    scroll_to_chosen_ = true;
  }
  act_when_built(ui, port);
  library_.poll();
  if (save_.busy() || stack_.busy() || library_.reading()) ui.again();
  // Other stacks have other entries by the same names.
  if (text_ != port.edits().stack_text()) bases_.forget();
  text_ = port.edits().stack_text();
  if (!save_.settling() && !port.status().building) bases_.follow(port);
}

void Panel::draw(Ui& ui, PanelPort& port, ImVec2 place, ImVec2 size) {
  turn(ui, port);
  ImGui::SetNextWindowPos(place);
  ImGui::SetNextWindowSize(size);
  constexpr int kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;
  if (ImGui::Begin("Settings", nullptr, kFlags)) {
    draw_head(ui, port);
    if (ImGui::CollapsingHeader("View")) draw_view_controls(ui, port);
    draw_settings(ui, port);
    draw_outcome(ui, port);
  }
  ImGui::End();
  draw_windows(ui);
}

void Panel::draw_windows(Ui& ui) {
  const ImVec2 area = ImGui::GetIO().DisplaySize;
  const ImVec2 size{std::min(ui.px(660), area.x * 0.95f), std::min(ui.px(480), area.y * 0.9f)};
  const auto effect = browser_.draw(ui, library_, {(area.x - size.x) / 2, (area.y - size.y) / 2}, size);
  if (effect) stack_.begin({StackEdit::Kind::add, *effect});
  if (const auto name = save_as_.draw(ui, area)) copy_due_ = copy_of(save_.file(), *name);
  if (stack_.busy() || save_.busy() || copy_due_) ui.again();  // the next turn takes it on
}

void Panel::save_as() {
  const std::filesystem::path folder = folder_for_copies(save_.file());
  const std::string keeper = keeper_of(save_.file());
  const std::filesystem::path same = folder / save_.file().filename();
  std::error_code ec;
  const std::filesystem::path name = !std::filesystem::exists(same, ec) ? same : free_name(same);
  const std::string place = "In " + (folder.empty() ? "the current folder" : folder.string());
  NameDialog::Question question{.title = "Save preset as",
                                .note = keeper.empty() ? place
                                                       : fmt::format("{} is of {} and stays. {}",
                                                                     save_.file().filename().string(), keeper, place),
                                .name = name.filename().string(),
                                .button = "Save",
                                .in_the_way = {}};
  question.in_the_way = [preset = save_.file()](const std::string& typed) -> std::optional<std::string> {
    std::error_code none;
    const std::filesystem::path file = copy_of(preset, typed);
    return std::filesystem::exists(file, none) ? std::optional(file.filename().string()) : std::nullopt;
  };
  save_as_.open(std::move(question));
}

void Panel::read_library(PanelPort& port) {
  if (const Preset* preset = port.preset()) library_.read(preset->path());
}

void Panel::add_effect(PanelPort& port) {
  read_library(port);
  browser_.open(pictures_());
}

bool Panel::close_windows() {
  const bool open = browser_.is_open() || save_as_.is_open();
  browser_.close();
  save_as_.close();
  return open;
}

/// While the file has an error the picture is that of the last good one: settings of a file that cannot be run are
/// shown, and rest. What was changed here may be what is wrong, and is mended here.
void Panel::draw_settings(Ui& ui, PanelPort& port) {
  const auto error = port.status().error;
  const auto& edits = port.edits().edits();
  const bool broken = error && edits.empty();
  if (error && port.build()) {
    const auto blamed = std::ranges::find_if(edits, [&](const SettingEdit& edit) { return names(*error, edit); });
    const std::string text = broken ? "The preset has an error. Settings rest until it is mended."
                             : blamed == edits.end()
                                 ? "The preset has an error: in the file, or by a change made here."
                                 : fmt::format("The error is in your change of {}.", name_of(*blamed));
    ImGui::PushStyleColor(ImGuiCol_Text, ui_color::kWarning);
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::PopStyleColor();
  }
  ui.values_apply = !broken;
  ImGui::BeginDisabled(broken);
  draw_arguments(ui, port);
  draw_entries(ui, port);
  ImGui::EndDisabled();
}

void Panel::draw_head(Ui& ui, PanelPort& port) {
  const Preset* preset = port.preset();
  ImGui::PushFont(ui.bold);
  const std::string name = preset ? preset->name() : "No preset yet";
  const std::string shown = shortened(name, ImGui::GetContentRegionAvail().x);
  ImGui::TextUnformatted(shown.c_str());
  ImGui::PopFont();
  ui.help((shown == name ? "" : name + "\n") + save_.file().string());
  const SettingEdits& edits = port.edits();
  const bool changed = !edits.none();
  if (small_button(ui, save_.busy() ? "Saving…" : "Save", "Write the changes into the preset's file (Ctrl+S)",
                   changed && !save_.busy()))
    save(port);
  beside("Save as…");
  if (small_button(ui, "Save as…", "Write the preset as it is now to another file, and go on with that (Ctrl+Shift+S)",
                   port.build() && !save_.busy()))
    save_as();
  beside("Open…");
  if (small_button(ui, "Open…", "The presets there are, each with this frame (Ctrl+O)")) ui.browse_presets();
  beside("Undo save");
  if (small_button(ui, "Undo save", "The file as it was before the last save", save_.can_undo())) undo_save(ui, port);
  if (small_button(ui, "Undo", "Ctrl+Z", edits.can_undo())) port.undo();
  beside("Redo");
  if (small_button(ui, "Redo", "Ctrl+Shift+Z", edits.can_redo())) port.redo();
  beside("Reset all");
  if (small_button(ui, "Reset all", "The stack and all settings as the file has them", changed)) {
    port.end_gesture();
    port.reset_all();
  }
  beside("Add effect");
  if (small_button(ui, stack_.busy() ? "Adding…###add" : "Add effect###add",
                   "Choose an effect to add to the stack (Ctrl+A)", port.build() && !stack_.busy()))
    add_effect(port);
  draw_conflict(ui, port);
  if (std::exchange(focus_search_, false)) focus_next_item();
  ImGui::SetNextItemWidth(-1);
  ImGui::InputTextWithHint("##search", "Search settings", search_.data(), search_.size(),
                           ImGuiInputTextFlags_AutoSelectAll);
}

std::string Panel::conflict_text() const {
  return fmt::format(
      "{0} was changed since its stack was changed here. The stack of here is shown, and edits of {0} have no effect",
      save_.file().filename().string());
}

/// The file was changed since the stack was changed here: a way to each.
void Panel::draw_conflict(const Ui& ui, PanelPort& port) {
  if (!stack_.conflict()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, ui_color::kWarning);
  ImGui::TextWrapped("%s", conflict_text().c_str());
  ImGui::PopStyleColor();
  draw_choice(ui, port);
}

void Panel::draw_choice(const Ui& ui, PanelPort& port) {
  if (small_button(ui, "Keep mine", "The stack as it is here; Save writes it over the file's")) stack_.keep();
  ImGui::SameLine();
  if (small_button(ui, "Take the file's", "The stack that the file has now; Undo brings this one back"))
    stack_.take(port);
}

// What the last save left out and why, or why it failed, over the end of the panel: nothing moves for it. So is a stack
// that the file disagrees with: the panel's top may be out of sight. What went well is said over the picture for a
// moment.
void Panel::draw_outcome(Ui& ui, PanelPort& port) {
  const bool saved = save_.failed() || !save_.refused().empty() || !save_.notes().empty();
  const bool conflict = stack_.conflict();
  if (!saved && !stack_.failed() && !conflict) return;
  std::vector<std::pair<ImU32, std::string>> lines;
  if (conflict) lines.emplace_back(ui_color::kWarning, conflict_text());
  if (stack_.failed()) lines.emplace_back(ui_color::kError, stack_.message());
  if (saved) {
    const ImU32 good = save_.refused().empty() ? ui_color::kGood : ui_color::kWarning;
    lines.emplace_back(save_.failed() ? ui_color::kError : good, save_.message());
  }
  for (const auto& refused : save_.refused()) lines.emplace_back(ui_color::kWarning, refused.reason.text());
  for (const auto& note : save_.notes()) lines.emplace_back(ui_color::kDim, note);

  const ImGuiStyle& style = ImGui::GetStyle();
  const float width = ImGui::GetWindowContentRegionMax().x - ImGui::GetWindowContentRegionMin().x;
  const float wrap = width - 2 * style.WindowPadding.x;
  float height = 2 * style.WindowPadding.y + (conflict ? 2.0f : 1.0f) * ImGui::GetFrameHeightWithSpacing();
  std::string all;
  for (const auto& [color, text] : lines) {
    height += ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap).y + style.ItemSpacing.y;
    all += (all.empty() ? "" : "\n") + text;
  }
  const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  height = std::min(height, size.y * 0.6f);
  ImGui::SetCursorScreenPos({at.x + style.WindowPadding.x, at.y + size.y - style.WindowPadding.y - height});
  ImGui::PushStyleColor(ImGuiCol_ChildBg, ui_color::kOverlay);
  if (ImGui::BeginChild("outcome", {width, height}, true)) {
    for (const auto& [color, text] : lines) {
      ImGui::PushStyleColor(ImGuiCol_Text, color);
      ImGui::TextWrapped("%s", text.c_str());
      ImGui::PopStyleColor();
    }
    if (conflict) draw_choice(ui, port);
    if (small_button(ui, "Copy", "The messages, to the clipboard")) ui.copy(all);
    ImGui::SameLine();
    if (small_button(ui, "Dismiss", "Hide the messages")) {
      save_.dismiss();
      stack_.dismiss();
    }
  }
  ImGui::EndChild();
  ImGui::PopStyleColor();
}

// What the preset asks of whoever runs it. The preset's text stays: arguments are given with the command.
void Panel::draw_arguments(Ui& ui, PanelPort& port) {
  const Preset* preset = port.preset();
  if (!preset || preset->arguments().empty()) return;
  const auto shows = [&](const PresetArgument& argument) {
    return found(argument.schema.name) || found(argument.schema.doc) || found("arguments");
  };
  const auto& arguments = preset->arguments();
  if (std::ranges::none_of(arguments, shows)) return;
  ImGui::PushID("arguments");
  if (ImGui::CollapsingHeader("Arguments", ImGuiTreeNodeFlags_DefaultOpen)) {
    for (const auto& argument : arguments)
      if (shows(argument))
        draw_row(ui, port, bases_,
                 {"", argument.schema.name, argument.schema, argument.value, nullptr, argument.given});
    const std::string words = argument_words(port.edits());
    if (small_button(ui, "Copy --arg", ("To the clipboard: " + words).c_str(), !words.empty())) ui.copy(words);
    ImGui::Spacing();
  }
  ImGui::PopID();
}

}  // namespace afterglow
