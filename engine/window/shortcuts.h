// SPDX-License-Identifier: MIT
// Keys and what they do: the one list that the main loop, the help sheet and the documents go by.
#pragma once

#include <optional>
#include <span>
#include <string>

namespace afterglow {

struct KeyPress {
  int key = 0;   ///< GLFW_KEY_…
  int mods = 0;  ///< of GLFW_MOD_SHIFT, GLFW_MOD_CONTROL, GLFW_MOD_ALT, GLFW_MOD_SUPER
  bool repeat = false;
};

enum class Action {
  play,
  shuttle_back,
  shuttle_pause,
  shuttle_forward,
  step_forward,
  step_back,
  jump_forward,
  jump_back,
  go_to_first,
  go_to_last,
  loop_mode,
  go_to_frame,
  mark,
  name_mark,
  next_mark,
  previous_mark,
  next_clip,
  previous_clip,
  range_begin,
  range_end,
  range_clear,
  sound,
  louder,
  quieter,
  slower,
  faster,
  fit,
  one_to_one,
  zoom_in,
  zoom_out,
  pan_left,
  pan_right,
  pan_up,
  pan_down,
  smooth,
  compare,
  turn_wipe,
  flip,
  side_by_side,
  difference,
  color,
  red,
  green,
  blue,
  alpha,
  luminance,
  exposure_up,
  exposure_down,
  exposure_reset,
  gamma_up,
  gamma_down,
  as_display,
  next_display_view,
  marks,
  background,
  guides,
  aspect,
  next_image,
  previous_image,
  result_image,
  scope,
  scope_scale,
  clear_region,
  stats,
  panel,
  transport,
  full_screen,
  next_pane,
  item_menu,
  print_keys,
  screenshot,
  export_frame,
  export_range,
  proxy,
  reload,
  copy_message,
  edit_file,
  undo,
  redo,
  keep_1,
  keep_2,
  keep_3,
  recall_1,
  recall_2,
  recall_3,
  save,
  undo_save,
  reset_all,
  save_as,
  browse_presets,
  search,
  add_effect,
  next_entry,
  previous_entry,
  entry_earlier,
  entry_later,
  duplicate_entry,
  remove_entry,
  toggle_entry,
  copy_settings,
  paste_settings,
  help,
  escape,
  quit,
};

struct Shortcut {
  Action action;
  int key;            ///< GLFW_KEY_…
  int mods;           ///< GLFW_MOD_…, exactly these
  const char* keys;   ///< as people read it: "Ctrl+S"
  const char* group;  ///< "Play", "Picture", "View", "Preset", "Stack", "Window"
  const char* doc;
  bool repeats = false;  ///< while the key is held
};

/// In the order of groups. An action may have several keys.
std::span<const Shortcut> shortcuts();
/// What a key does; none: nothing, or it is held and does not repeat.
std::optional<Action> action_of(const KeyPress& press);
/// The keys of an action as people read them, "F1 or ?"; for tooltips.
std::string keys_of(Action action);

}  // namespace afterglow
