// SPDX-License-Identifier: MIT
// What those who draw the interface share.
#pragma once

#include <imgui.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "image/ocio.h"
#include "window/atlas_cells.h"
#include "window/hover_help.h"
#include "window/sheet_places.h"
#include "window/typed_text.h"
#include "window/typed_value.h"

namespace afterglow {

class Player;

/// Parts of the window that the keyboard can go to. While it is at the picture, keys are shortcuts.
enum class Pane { picture, panel, bar, strip };

/// Of the bar below the picture: rows of buttons, and its height with the timeline.
struct BarShape {
  int rows = 1;
  float height = 0;
};

/// State of the interface, and its tools. Drawing thread alone. Those who draw talk to the Player and to this, and to
/// nothing of the window: they can be tested with ImGui alone.
struct Ui {
  float scale = 1;  ///< pixels for a pixel of a plain display: multiply every size by it
  ImFont* body = nullptr;
  ImFont* bold = nullptr;
  ImFont* mono = nullptr;  ///< for numbers and messages

  bool show_panel = true;
  bool show_transport = true;
  bool show_help = false;
  ImVec2 help_area;      ///< that the help sheet was last drawn in
  int help_settles = 0;  ///< frames that it still takes to find its size
  bool show_frame_field = false;
  bool show_stats = false;

  std::string display;                        ///< that pictures are shown on; empty: none is named, and it is sRGB
  std::string display_name, display_view;     ///< of an OpenColorIO configuration
  std::vector<OcioSurvey::Display> displays;  ///< that it has; empty: there is none
  /// Shows pictures through another one. An empty view is the display's first.
  std::function<void(const std::string& display, const std::string& view)> choose_display = [](const std::string&,
                                                                                               const std::string&) {};
  Size picture_window;  ///< what one picture has of the window, in pixels of the frame buffer
  double now = 0;       ///< seconds of a clock that never goes backwards
  /// Puts text on the clipboard.
  std::function<void(const std::string&)> copy = [](const std::string&) {};
  /// Opens a preset, a picture or a sequence, as if it had been dropped on the window.
  std::function<void(const std::string&)> open = [](const std::string&) {};
  /// Opens a preset as B.
  std::function<void(const std::string&)> open_other = [](const std::string&) {};
  /// Shows the presets that can be opened.
  std::function<void()> browse_presets = [] {};
  /// Opens a file at a line in the user's editor, and says so when that fails.
  std::function<void(const std::string& file, int line)> edit_file = [](const std::string&, int) {};
  /// Draws another frame soon, though nothing else will have changed.
  std::function<void()> again = [] {};

  /// Says something for a few seconds, over the picture.
  void say(const std::string& text) {
    message = text;
    message_until = now + 3;
  }
  /// Tells about the item that was drawn last, while the pointer rests on it.
  void help(const std::string& text) const;
  std::string message;
  double message_until = 0;
  mutable HoverHelp hover;     ///< what `help` remembers
  mutable SheetPlaces sheets;  ///< that lie over the picture
  /// A field gets the keyboard within a few frames: what is typed meanwhile is for it.
  bool field_opens = false;
  Pane pane = Pane::picture;  ///< that has the keyboard
  bool item_menu = false;     ///< for this frame: the chosen item shows what a right click shows
  bool values_apply = true;   ///< false: settings are shown and cannot be changed
  struct {
    std::array<char, 32> text{};
    bool begin = false;  ///< it gets the keyboard with the next frame
  } frame_field;
  TypedValue typed;  ///< the setting that is being typed
  TypedText texts;   ///< …and those that are texts
  AtlasCells cells;  ///< scopes are drawn into them

  float px(float size) const { return size * scale; }
};

/// As much of a text as a width shows, with "…" for the rest. Within a frame of ImGui.
std::string shortened(const std::string& text, float width);
/// Gives the keyboard to the item that is drawn next.
void focus_next_item();
/// The item that was drawn last is right-clicked, or chosen by the keyboard and its menu asked for.
bool wants_menu(const Ui& ui);
/// Escape went down in this frame.
bool escape_pressed();

/// True in the frame of a double click: the fourth of four quick clicks is one too, as two of them are two double
/// clicks.
bool double_clicked();

/// The colours of the interface.
namespace ui_color {
inline constexpr ImU32 kText = IM_COL32(222, 224, 228, 255), kDim = IM_COL32(153, 157, 165, 255),
                       kAccent = IM_COL32(255, 158, 60, 255), kError = IM_COL32(255, 107, 97, 255),
                       kWarning = IM_COL32(240, 196, 84, 255), kGood = IM_COL32(120, 200, 130, 255),
                       kOverlay = IM_COL32(16, 17, 19, 238), kLine = IM_COL32(58, 61, 67, 255);
}  // namespace ui_color

}  // namespace afterglow
