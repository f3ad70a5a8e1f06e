// SPDX-License-Identifier: MIT
#include "window/play_parts.h"

#include "window/help_sheet.h"
#include "window/transport_bar.h"

namespace afterglow {

PlayParts::PlayParts(Player& player, const ExportSetup& setup, Diagnostics& diagnostics)
    : player_(player),
      port_(player),
      preset_options_(setup.stack.preset),
      export_(setup.to, diagnostics),
      range_export_(setup, diagnostics) {
  panel_.emplace(setup.preset, preset_options_);
}

void PlayParts::draw_transport(Player& player, Ui& ui, ImVec2 place, ImVec2 size) const {
  TransportBarState state{.timeline = {.transport = player.transport(),
                                       .now = player.now(),
                                       .shown = player.shown().position,
                                       .number = [&player](int at) { return player.footage().frame(at).number; },
                                       .state = [&player](int at) { return player.frame_state(at); }},
                          .view = player.view(),
                          .picture = player.images().picture,
                          .window = ui.picture_window,
                          .fps = player.fps(),
                          .late = player.late(),
                          .name = player.shown().name};
  draw_transport_bar(ui, state, place, size);
}

void PlayParts::ask_for_range(Ui& ui) {
  if (range_export_.busy()) return ui.say("an export is under way: " + range_export_.state());
  NameDialog::Question question{
      .title = "Export " + range_export_.range_text(player_),
      .note = "A sequence (out.####.exr) or a video (out.mp4). The look is that of now, whatever changes meanwhile.",
      .name = range_export_.proposed(player_),
      .button = "Export",
      .in_the_way = {}};
  question.in_the_way = [this](const std::string& name) -> std::optional<std::string> {
    const auto file = range_export_.in_the_way(player_, name);
    return file ? std::optional(file->filename().string()) : std::nullopt;
  };
  range_name_.open(std::move(question));
}

void PlayParts::draw_dialogs(Ui& ui) {
  if (const auto name = range_name_.draw(ui, ImGui::GetIO().DisplaySize)) range_export_.begin(player_, ui, *name);
}

std::string PlayParts::unsaved() {
  const std::string changes = panel_->unsaved(port_);
  if (!range_export_.busy()) return changes;
  const std::string rest = "the rest of an export (" + range_export_.state() + ")";
  return changes.empty() ? rest : changes + " and " + rest;
}

void PlayParts::draw_panel(Ui& ui, ImVec2 place, ImVec2 size) {
  export_.poll(ui);
  range_export_.poll(player_, ui);
  panel_->draw(ui, port_, place, size);
}

bool PlayParts::edit_stack(Ui& ui, Action action) {
  using EntryAction = Panel::EntryAction;
  const auto act = [&](EntryAction what) {
    panel_->act(ui, port_, what);
    return false;
  };
  switch (action) {
    case Action::add_effect:
      panel_->add_effect(port_);
      return true;
    case Action::save_as:
      panel_->save_as();
      return true;
    case Action::next_entry:
      panel_->choose_next(ui, port_, 1);
      return false;
    case Action::previous_entry:
      panel_->choose_next(ui, port_, -1);
      return false;
    case Action::entry_earlier:
      return act(EntryAction::earlier);
    case Action::entry_later:
      return act(EntryAction::later);
    case Action::duplicate_entry:
      return act(EntryAction::duplicate);
    case Action::remove_entry:
      return act(EntryAction::remove);
    case Action::toggle_entry:
      return act(EntryAction::toggle);
    case Action::copy_settings:
      return act(EntryAction::copy);
    case Action::paste_settings:
      return act(EntryAction::paste);
    default:
      return false;
  }
}

void PlayParts::add_to(WindowOptions& options) {
  options.panel = [this](Player&, Ui& ui, ImVec2 place, ImVec2 size) { draw_panel(ui, place, size); };
  options.hidden_panel = [this](Player&, Ui& ui) {
    export_.poll(ui);
    range_export_.poll(player_, ui);
    panel_->turn(ui, port_);
  };
  options.export_frame = [this](Player& player, Ui& ui) { export_.begin(player, ui); };
  options.transport = [this](Player& player, Ui& ui, ImVec2 place, ImVec2 size) {
    draw_transport(player, ui, place, size);
  };
  options.transport_height = [](const Ui& ui, float width) { return transport_bar_height(ui, width); };
  options.help = [](Player&, Ui& ui, ImVec2, ImVec2 size) { draw_help_sheet(ui, size); };
  options.save = [this](Player&, Ui&) { panel_->save(port_); };
  options.unsaved = [this](Player&) { return unsaved(); };
  options.dialogs = [this](Player&, Ui& ui) { draw_dialogs(ui); };
  options.strip = [this](Player&, Ui& ui, ImVec2 place, ImVec2 size) { range_export_.draw(ui, place, size); };
  options.strip_height = [this](const Ui& ui) { return range_export_.busy() ? ui.px(40) : 0; };
  options.export_range = [this](Player&, Ui& ui) { ask_for_range(ui); };
  options.saving = [this] {
    const PanelSave& save = panel_->saving();
    if (panel_->busy()) return WindowOptions::Saving::busy;
    return save.failed() || !save.refused().empty() ? WindowOptions::Saving::failed : WindowOptions::Saving::done;
  };
  options.undo_save = [this](Player&, Ui& ui) {
    if (!panel_->saving().can_undo()) return ui.say("nothing was saved");
    panel_->undo_save(port_);
  };
  options.edit_stack = [this](Player&, Ui& ui, Action action) { return edit_stack(ui, action); };
  options.close_windows = [this] {
    const bool open = range_name_.is_open();
    range_name_.close();
    return panel_->close_windows() || open;
  };
  options.search = [this](Player&, Ui&) { panel_->search(); };
  options.preset_opened = [this](const std::filesystem::path& preset) {
    panel_.emplace(preset, preset_options_);
    range_export_.preset_opened(preset);
  };
}

}  // namespace afterglow
