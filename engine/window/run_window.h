// SPDX-License-Identifier: MIT
// The main loop of a window that plays.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "core/diagnostics.h"
#include "core/geometry.h"
#include "gpu/device.h"
#include "play/player.h"
#include "window/desktop_window.h"
#include "window/display_keeper.h"
#include "window/shortcuts.h"
#include "window/ui.h"

namespace afterglow {

struct WindowOptions {
  std::optional<float> scale;  ///< of the interface; none: the desktop's
  bool full_screen = false;
  bool stats = false;                    ///< shown from the start
  std::optional<ShownDisplay> display;   ///< that pictures are shown on; none: sRGB
  MakeDisplay make_display;              ///< makes it anew, or another; empty: it stays
  bool tearing = false;                  ///< see SwapchainOptions
  bool check = false;                    ///< each frame is drawn wholly too, and compared (window/paint_check.h)
  std::filesystem::path captures = ".";  ///< folder for screenshots by key
  /// A part of the interface, drawn as an ImGui window at `place`. Without one, its place is the picture's.
  using Part = std::function<void(Player&, Ui&, ImVec2 place, ImVec2 size)>;
  Part panel;                                                       ///< at the right
  Part transport;                                                   ///< at the bottom
  std::function<BarShape(const Ui&, float width)> transport_shape;  ///< that it wants
  Part help;                                                        ///< over everything
  /// Ctrl+S; empty: there is no such thing. True: a field is about to get the keyboard.
  std::function<bool(Player&, Ui&)> save;
  /// What the window would forget when it is closed or another preset is opened, for people: "2 settings of look.lua".
  /// Empty: nothing.
  std::function<std::string(Player&)> unsaved;
  enum class Saving { busy, done, failed };
  std::function<Saving()> saving;                  ///< what has become of the last `save`
  std::function<void(Player&, Ui&)> export_frame;  ///< S
  std::function<void(Player&, Ui&)> export_range;  ///< Ctrl+R: asks where; a field gets the keyboard
  std::function<Saving()> exporting;          ///< what has become of the last `export_range`; failed: cancelled too
  std::function<std::string()> export_state;  ///< while it is busy: "frame 3 of 12 to out.mp4"
  std::function<void(Player&, Ui&)> dialogs;  ///< drawn in each frame, over everything but the help
  Part strip;                                 ///< between picture and transport, while it wants a height
  std::function<float(const Ui&, float width)> strip_height;
  std::function<void(Player&, Ui&)> undo_save;  ///< takes back the last `save`
  std::function<void(Player&, Ui&)> search;     ///< the keyboard goes to the panel's search
  /// Keys that are about the stack, and Save as. True: a field is about to get the keyboard.
  std::function<bool(Player&, Ui&, Action)> edit_stack;
  std::function<void(Player&, Ui&)> browse_presets;  ///< Ctrl+O: asks which; a field gets the keyboard
  /// Asked in each turn: true once when something that is drawn came from elsewhere, and a frame is due.
  std::function<bool()> news;
  /// Keys that are about markers. True: a field is about to get the keyboard.
  std::function<bool(Player&, Ui&, Action)> marks;
  std::function<bool()> close_windows;             ///< Esc; false: nothing was open
  std::function<void(Player&, Ui&)> hidden_panel;  ///< called in place of `panel` while that is hidden
  /// Another preset is being played from here on.
  std::function<void(const std::filesystem::path&)> preset_opened;
  std::function<bool()> interrupted = [] { return false; };  ///< true: close as by key
};

/// Shows what the player plays until the window is closed. `player` must have been opened on `device`, that with the
/// window's presentation, and with DesktopWindow::wake as its wake. Main thread. Does nothing, and uses no processor
/// time, while nothing changes. Notes each picture that it shows as "shown …" and each build as "reload …" in
/// `diagnostics`. Errors: device (lost, display gone).
Result<void> run_window(DesktopWindow& window, Device& device, Player& player, const WindowOptions& options,
                        Diagnostics& diagnostics);

}  // namespace afterglow
