// SPDX-License-Identifier: MIT
// What is drawn over the picture. Each talks to the Player and ImGui alone.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "play/player.h"
#include "window/error_lines.h"
#include "window/ui.h"

namespace afterglow {

/// The picture's part of the window, in ImGui's coordinates.
struct OverlayArea {
  ImVec2 at, size;
};

/// Where pixels of the picture lie on the screen.
struct OverlayPicture {
  ViewPlacement place;
  Size picture, window;  ///< of what one picture has of the window, in pixels of the frame buffer
  int right = 0;         ///< how far the result is from there, where two lie side by side
  ImVec2 pixel{1, 1};    ///< of the frame buffer, in ImGui's coordinates
};

/// What has been found about the picture that is shown.
struct ShownScopes {
  std::optional<Scopes> scopes;
  std::optional<RegionMeans> means;
};

/// What is wrong at the moment, as one would mail it to somebody; empty: nothing.
std::string current_message(const Player& player);

/// The places that it is about, the first error's first; without an error the preset's file.
std::vector<ErrorPlace> current_places(const Player& player);

/// What is compared, in words: "before | after", "warm.lua | look.lua"; "result" when nothing is.
std::string comparison_text(Player& player);

/// The message of a preset, picture or frame that fails, over the last good picture, with a button that copies it.
void draw_error_overlay(Player& player, Ui& ui, const OverlayArea& area);
/// Upper left: what makes the picture look other than the result: image between passes, channel, exposure, marks.
void draw_state_overlay(Player& player, const Ui& ui, const OverlayArea& area);
/// Upper right: frame rate, frame times, drops, and where the time of the last reload went.
void draw_stats_overlay(const Player& player, const Ui& ui, const OverlayArea& area);
/// Lower right: the scopes that the view asks for (Ui::cells has them), what does not fit, and means of the region, in
/// the room that the sheets leave which were drawn before; where that is none, it says so.
void draw_scopes_overlay(const ShownScopes& shown, const View& view, const Ui& ui, const OverlayArea& area);
/// A frame around the region of the view.
void draw_region(const Rect& region, const Ui& ui, const OverlayPicture& place);
/// A frame around the pixel whose values are told.
void draw_pixel_mark(Pixel pixel, const Ui& ui, const OverlayPicture& place);
/// Guides of the view, and what its form leaves out, over each picture that is shown.
void draw_guides(const View& view, const Ui& ui, const OverlayPicture& place);
/// What the mark says; `picture`: there is one on screen.
std::string frame_mark_text(const ShownFrame& shown, bool picture);
/// Around the picture and above it: that it is not the frame that is asked for, because that is missing or unreadable.
void draw_frame_mark(const Player& player, const Ui& ui, const OverlayPicture& place, const OverlayArea& area);
/// Lower left: values of source and result. In a narrow part of the window a column, which makes way for scopes.
void draw_probe_overlay(const Probe& probe, const View& view, const Ui& ui, const OverlayArea& area);
/// Ui::message, while it lasts.
void draw_message_overlay(const Ui& ui, const OverlayArea& area);

}  // namespace afterglow
