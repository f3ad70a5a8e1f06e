// SPDX-License-Identifier: MIT
#include "window/play_parts.h"

#include "window/help_sheet.h"
#include "window/transport_bar.h"

namespace afterglow {

PlayParts::PlayParts(Player& player, const std::filesystem::path& preset, const PresetOptions& options,
                     const std::filesystem::path& exports, Diagnostics& diagnostics)
    : port_(player), preset_options_(options), export_(exports, diagnostics) {
  panel_.emplace(preset, preset_options_);
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

void PlayParts::draw_panel(Ui& ui, ImVec2 place, ImVec2 size) {
  export_.poll(ui);
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
    panel_->turn(ui, port_);
  };
  options.export_frame = [this](Player& player, Ui& ui) { export_.begin(player, ui); };
  options.transport = [this](Player& player, Ui& ui, ImVec2 place, ImVec2 size) {
    draw_transport(player, ui, place, size);
  };
  options.transport_height = [](const Ui& ui, float width) { return transport_bar_height(ui, width); };
  options.help = [](Player&, Ui& ui, ImVec2, ImVec2 size) { draw_help_sheet(ui, size); };
  options.save = [this](Player&, Ui&) { panel_->save(port_); };
  options.unsaved = [this](Player&) { return panel_->unsaved(port_); };
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
  options.close_windows = [this] { return panel_->close_windows(); };
  options.search = [this](Player&, Ui&) { panel_->search(); };
  options.preset_opened = [this](const std::filesystem::path& preset) { panel_.emplace(preset, preset_options_); };
}

}  // namespace afterglow
