// SPDX-License-Identifier: MIT
#include "window/play_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "window/desktop_window.h"
#include "window/help_sheet.h"
#include "window/transport_bar.h"

namespace afterglow {

PlayParts::PlayParts(Player& player, const ExportSetup& setup, Diagnostics& diagnostics)
    : player_(player),
      port_(player),
      preset_options_(setup.stack.preset),
      export_(setup.to, diagnostics),
      range_export_(setup, diagnostics),
      preset_(setup.preset),
      thumbnails_(std::make_unique<Thumbnails>(setup.device, setup.stack, [this] {
        news_ = true;
        DesktopWindow::wake();
      })) {
  open_panel(setup.preset);
}

void PlayParts::open_panel(const std::filesystem::path& preset) {
  preset_ = preset;
  panel_.emplace(preset, preset_options_);
  panel_->set_pictures([this] { return effect_pictures(); });
}

void PlayParts::draw_transport(Player& player, Ui& ui, ImVec2 place, ImVec2 size) {
  TransportBarState state{.timeline = {.transport = player.transport(),
                                       .now = player.now(),
                                       .shown = player.shown().position,
                                       .number = [&player](int at) { return player.footage().frame(at).number; },
                                       .state = [&player](int at) { return player.frame_state(at); },
                                       .footage = player.footage(),
                                       .markers = marks_.markers(player)},
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

/// As it was read, without the look; the preset is told what it is told while it is played.
ThumbnailFrame PlayParts::thumbnail_frame() const {
  const ShownFrame& shown = player_.shown();
  ThumbnailFrame out{.picture = player_.source(), .context = {}, .read = player_.reader_with_inputs()};
  out.context.frame = shown.number;
  out.context.fps = player_.transport().fps();
  const auto time = shown.position >= 0 ? player_.footage().frame(shown.position).time : std::nullopt;
  out.context.time = time.value_or(shown.number / out.context.fps);
  return out;
}

void PlayParts::browse_presets() {
  PresetBrowser::Source source;
  source.find = [this](const std::filesystem::path& file) { return thumbnails_->find(file); };
  source.want = [this](const std::vector<std::filesystem::path>& files) {
    thumbnails_->want({files.begin(), files.end()});
  };
  panel_->close_windows();  // one list at a time
  thumbnails_of_ = -1;
  presets_.open(list_presets(preset_, preset_options_), preset_, std::move(source));
}

/// The look as it is on screen when the list is opened, with one effect more.
EffectBrowser::Source PlayParts::effect_pictures() {
  ChangedLook look{.text = {},
                   .overrides = player_.live().overrides(),
                   .arguments = player_.edits().arguments(preset_options_.arguments)};
  if (const StackText& text = player_.edits().stack_text()) look.text = *text;
  const auto changed = std::make_shared<const ChangedLook>(std::move(look));
  presets_.close();  // one list at a time
  thumbnails_of_ = -1;
  EffectBrowser::Source source;
  source.find = [this, changed](const std::string& effect) { return thumbnails_->find({preset_, changed, effect}); };
  source.want = [this, changed](const std::vector<std::string>& effects) {
    std::vector<ThumbnailOf> wanted;
    for (const std::string& effect : effects) wanted.emplace_back(preset_, changed, effect);
    thumbnails_->want(std::move(wanted));
  };
  return source;
}

/// They are of the frame at which the list was opened, and of another once that stands.
void PlayParts::follow_thumbnails() {
  const bool seen = presets_.is_open() || panel_->lists_effects();
  if (std::exchange(thumbnails_seen_, seen) && !seen) thumbnails_->rest();
  const int position = player_.shown().position;
  if (!seen || !player_.source() || position == thumbnails_of_) return;
  if (thumbnails_of_ >= 0 && player_.transport().playing()) return;
  thumbnails_of_ = position;
  thumbnails_->set_frame(thumbnail_frame());
}

void PlayParts::draw_presets(Ui& ui) {
  const bool was_open = presets_.is_open();
  const auto choice = presets_.draw(ui, was_open ? panel_->unsaved(port_) : "", ImGui::GetIO().DisplaySize);
  follow_thumbnails();
  if (!choice) return;
  if (choice->other) {
    ui.open_other(choice->file.string());
  } else {
    ui.open(choice->file.string());
  }
}

void PlayParts::draw_dialogs(Ui& ui) {
  draw_presets(ui);
  marks_.draw(player_, ui);
  if (const auto name = range_name_.draw(ui, ImGui::GetIO().DisplaySize)) range_export_.begin(player_, ui, *name);
}

std::string PlayParts::unsaved() {
  std::string changes = panel_->unsaved(port_);
  const auto arguments =
      std::ranges::count_if(player_.edits().edits(), [](const auto& edit) { return edit.entry.empty(); });
  if (arguments > 0)
    changes += fmt::format("{}{} {}, which no preset holds: they are given by {}", changes.empty() ? "" : " and ",
                           arguments, arguments == 1 ? "argument" : "arguments", argument_words(player_.edits()));
  return changes;
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
  options.transport_shape = [](const Ui& ui, float width) { return transport_bar_shape(ui, width); };
  options.help = [](Player&, Ui& ui, ImVec2, ImVec2 size) { draw_help_sheet(ui, size); };
  options.save = [this](Player&, Ui&) { return panel_->save(port_); };
  options.unsaved = [this](Player&) { return unsaved(); };
  options.dialogs = [this](Player&, Ui& ui) { draw_dialogs(ui); };
  options.strip = [this](Player&, Ui& ui, ImVec2 place, ImVec2 size) { range_export_.draw(ui, place, size); };
  options.strip_height = [this](const Ui& ui, float width) { return range_export_.height(ui, width); };
  options.exporting = [this] {
    using Saving = WindowOptions::Saving;
    return range_export_.busy() ? Saving::busy : range_export_.whole() ? Saving::done : Saving::failed;
  };
  options.export_state = [this] { return range_export_.state(); };
  options.export_range = [this](Player&, Ui& ui) { ask_for_range(ui); };
  options.saving = [this] {
    const PanelSave& save = panel_->saving();
    // What was changed since is an edit again once the file that was written is on screen.
    const bool settles = save.settling() && !player_.live().status().error;
    if (panel_->busy() || settles) return WindowOptions::Saving::busy;
    const bool asks = panel_->asks_for_name();
    return asks || save.failed() || !save.refused().empty() ? WindowOptions::Saving::failed
                                                            : WindowOptions::Saving::done;
  };
  options.undo_save = [this](Player&, Ui& ui) {
    if (!panel_->saving().can_undo()) return ui.say("nothing was saved");
    panel_->undo_save(ui, port_);
  };
  options.edit_stack = [this](Player&, Ui& ui, Action action) { return edit_stack(ui, action); };
  options.marks = [this](Player& player, Ui& ui, Action action) { return marks_.act(player, ui, action); };
  options.close_windows = [this] {
    const bool open = range_name_.is_open();
    range_name_.close();
    const bool browsed = presets_.is_open();
    presets_.close();
    const bool marks = marks_.close_windows();
    return panel_->close_windows() || open || browsed || marks;
  };
  options.browse_presets = [this](Player&, Ui&) { browse_presets(); };
  options.news = [this] { return news_.exchange(false); };
  options.search = [this](Player&, Ui&) { panel_->search(); };
  options.preset_opened = [this](const std::filesystem::path& preset) {
    open_panel(preset);
    range_export_.preset_opened(preset);
  };
}

}  // namespace afterglow
