// SPDX-License-Identifier: MIT
#include "window/play_parts.h"

#include "window/help_sheet.h"
#include "window/transport_bar.h"

namespace afterglow {

PlayParts::PlayParts(Player& player, const std::filesystem::path& preset, const PresetOptions& options)
    : port_(player), preset_options_(options) {
  panel_.emplace(preset, preset_options_);
}

void PlayParts::draw_transport(Player& player, Ui& ui, ImVec2 place, ImVec2 size) const {
  TransportBarState state{.transport = player.transport(),
                          .now = player.now(),
                          .shown = player.shown().position,
                          .number = [&player](int position) { return player.footage().frame(position).number; },
                          .cached = [&player](int position) { return player.in_memory(position); },
                          .fps = player.fps(),
                          .late = player.late(),
                          .picture = player.shown().name};
  draw_transport_bar(ui, state, place, size);
}

void PlayParts::add_to(WindowOptions& options) {
  options.panel = [this](Player&, Ui& ui, ImVec2 place, ImVec2 size) { panel_->draw(ui, port_, place, size); };
  options.hidden_panel = [this](Player&, Ui& ui) { panel_->turn(ui, port_); };
  options.transport = [this](Player& player, Ui& ui, ImVec2 place, ImVec2 size) {
    draw_transport(player, ui, place, size);
  };
  options.transport_height = [](const Ui& ui) { return transport_bar_height(ui); };
  options.help = [](Player&, Ui& ui, ImVec2, ImVec2 size) { draw_help_sheet(ui, size); };
  options.save = [this](Player&, Ui&) { panel_->save(port_); };
  options.undo_save = [this](Player&, Ui& ui) {
    if (!panel_->saving().can_undo()) return ui.say("nothing was saved");
    panel_->undo_save(port_);
  };
  options.search = [this](Player&, Ui&) { panel_->search(); };
  options.preset_opened = [this](const std::filesystem::path& preset) { panel_.emplace(preset, preset_options_); };
}

}  // namespace afterglow
