// SPDX-License-Identifier: MIT
#include "window/mark_keys.h"

#include <fmt/format.h>

#include "core/user_folders.h"
#include "play/player.h"

namespace afterglow {
namespace {

std::filesystem::path markers_folder() {
  const auto state = state_folder();
  return state.empty() ? state : state / "markers";
}

std::string marker_text(const Player& player, const Marker& marker) {
  const int number = player.footage().frame(marker.position).number;
  return marker.name.empty() ? fmt::format("marker at frame {}", number)
                             : fmt::format("{} (frame {})", marker.name, number);
}

}  // namespace

MarkKeys::MarkKeys() : markers_(markers_folder()) {}

const Markers& MarkKeys::markers(Player& player) {
  markers_.follow(player.footage().shared_from_this());
  return markers_;
}

void MarkKeys::go(Player& player, Ui& ui, const std::optional<Marker>& marker, const char* none) {
  if (!marker) return ui.say(none);
  player.transport().go_to(marker->position, player.now());
  ui.say(marker_text(player, *marker));
}

bool MarkKeys::act(Player& player, Ui& ui, Action action) {
  markers(player);
  const int at = player.transport().position();
  const int number = player.footage().frame(at).number;
  switch (action) {
    case Action::mark: {
      const auto marked = markers_.toggle(at);
      ui.say(!marked   ? marked.error().text()
             : *marked ? fmt::format("frame {} is marked; Ctrl+M names it", number)
                       : fmt::format("frame {} is no longer marked", number));
      return false;
    }
    case Action::name_mark: {
      const auto known = markers_.at(at);
      player.transport().pause(player.now());
      named_ = at;
      name_.open({.title = fmt::format("Marker at frame {}", number),
                  .note = "Any words, or none. They are shown over the timeline.",
                  .name = known ? known->name : "",
                  .button = "Mark",
                  .in_the_way = {},
                  .may_be_empty = true});
      return true;
    }
    case Action::next_mark:
      go(player, ui, markers_.next(at), "no marker behind this frame (Shift+M sets one)");
      return false;
    case Action::previous_mark:
      go(player, ui, markers_.previous(at), "no marker before this frame (Shift+M sets one)");
      return false;
    default:
      return false;
  }
}

void MarkKeys::draw(Player& player, Ui& ui) {
  const auto name = name_.draw(ui, ImGui::GetIO().DisplaySize);
  if (!name) return;
  markers(player);
  if (named_ >= player.footage().frames()) return;  // other footage was opened meanwhile
  const auto done = markers_.name(named_, *name);
  ui.say(done ? fmt::format("frame {} is marked", player.footage().frame(named_).number) : done.error().text());
}

bool MarkKeys::close_windows() {
  const bool open = name_.is_open();
  name_.close();
  return open;
}

}  // namespace afterglow
