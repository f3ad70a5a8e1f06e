// SPDX-License-Identifier: MIT
#include "window/shortcuts.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace afterglow {

namespace {

constexpr int kNone = 0, kShift = GLFW_MOD_SHIFT, kControl = GLFW_MOD_CONTROL,
              kBoth = GLFW_MOD_SHIFT | GLFW_MOD_CONTROL;

constexpr Shortcut kShortcuts[] = {
    {Action::play, GLFW_KEY_SPACE, kNone, "Space", "Play", "Play or pause"},
    {Action::shuttle_back, GLFW_KEY_J, kNone, "J", "Play", "Backwards; again: faster"},
    {Action::shuttle_pause, GLFW_KEY_K, kNone, "K", "Play", "Pause"},
    {Action::shuttle_forward, GLFW_KEY_L, kNone, "L", "Play", "Forwards; again: faster"},
    {Action::step_forward, GLFW_KEY_RIGHT, kNone, "Right", "Play", "One frame on", true},
    {Action::step_back, GLFW_KEY_LEFT, kNone, "Left", "Play", "One frame back", true},
    {Action::jump_forward, GLFW_KEY_RIGHT, kShift, "Shift+Right", "Play", "Ten frames on", true},
    {Action::jump_back, GLFW_KEY_LEFT, kShift, "Shift+Left", "Play", "Ten frames back", true},
    {Action::go_to_first, GLFW_KEY_HOME, kNone, "Home", "Play", "To the first frame of the range"},
    {Action::go_to_last, GLFW_KEY_END, kNone, "End", "Play", "To the last frame of the range"},
    {Action::go_to_frame, GLFW_KEY_G, kControl, "Ctrl+G", "Play", "To a frame: its number, +12, -3 or a timecode"},
    {Action::mark, GLFW_KEY_M, kShift, "Shift+M", "Play", "Mark the frame, or take its marker away"},
    {Action::name_mark, GLFW_KEY_M, kControl, "Ctrl+M", "Play", "Mark the frame, with a name"},
    {Action::next_mark, GLFW_KEY_RIGHT, kControl, "Ctrl+Right", "Play", "To the next marker", true},
    {Action::previous_mark, GLFW_KEY_LEFT, kControl, "Ctrl+Left", "Play", "To the marker before", true},
    {Action::next_clip, GLFW_KEY_RIGHT, kBoth, "Ctrl+Shift+Right", "Play", "To the next clip of several", true},
    {Action::previous_clip, GLFW_KEY_LEFT, kBoth, "Ctrl+Shift+Left", "Play",
     "To the clip's first frame, then the clip before", true},
    {Action::loop_mode, GLFW_KEY_L, kShift, "Shift+L", "Play", "Once, loop, ping-pong"},
    {Action::range_begin, GLFW_KEY_I, kNone, "I", "Play", "The range begins here"},
    {Action::range_end, GLFW_KEY_O, kNone, "O", "Play", "The range ends here"},
    {Action::range_clear, GLFW_KEY_P, kNone, "P", "Play", "Play the whole sequence again"},
    {Action::slower, GLFW_KEY_COMMA, kNone, ",", "Play", "Half the speed", true},
    {Action::faster, GLFW_KEY_PERIOD, kNone, ".", "Play", "Twice the speed", true},
    {Action::sound, GLFW_KEY_U, kNone, "U", "Play", "Sound of videos off, on"},
    {Action::quieter, GLFW_KEY_LEFT_BRACKET, kNone, "[", "Play", "Quieter", true},
    {Action::louder, GLFW_KEY_RIGHT_BRACKET, kNone, "]", "Play", "Louder", true},

    {Action::color, GLFW_KEY_C, kNone, "C", "Picture", "All channels"},
    {Action::red, GLFW_KEY_R, kNone, "R", "Picture", "Red alone"},
    {Action::green, GLFW_KEY_G, kNone, "G", "Picture", "Green alone"},
    {Action::blue, GLFW_KEY_B, kNone, "B", "Picture", "Blue alone"},
    {Action::alpha, GLFW_KEY_A, kNone, "A", "Picture", "Alpha"},
    {Action::luminance, GLFW_KEY_Y, kNone, "Y", "Picture", "Luminance"},
    {Action::exposure_up, GLFW_KEY_UP, kNone, "Up", "Picture", "A quarter stop brighter (the view alone)", true},
    {Action::exposure_down, GLFW_KEY_DOWN, kNone, "Down", "Picture", "A quarter stop darker", true},
    {Action::exposure_reset, GLFW_KEY_0, kNone, "0", "Picture", "Exposure and gamma as they are"},
    {Action::gamma_up, GLFW_KEY_UP, kShift, "Shift+Up", "Picture", "More gamma (the view alone)", true},
    {Action::gamma_down, GLFW_KEY_DOWN, kShift, "Shift+Down", "Picture", "Less gamma", true},
    {Action::as_display, GLFW_KEY_V, kShift, "Shift+V", "Picture",
     "As --view-ocio or --view-icc say, or as sRGB (the view alone)"},
    {Action::next_display_view, GLFW_KEY_V, kControl, "Ctrl+V", "Picture", "The next view of that display", true},
    {Action::marks, GLFW_KEY_X, kNone, "X", "Picture", "Marks: none, what is out of range, zones of a stop each"},
    {Action::background, GLFW_KEY_K, kShift, "Shift+K", "Picture", "Behind transparency: nothing, grey, checkers"},
    {Action::guides, GLFW_KEY_G, kShift, "Shift+G", "Picture", "Lines: none, thirds, safe areas, both"},
    {Action::aspect, GLFW_KEY_A, kShift, "Shift+A", "Picture", "Darken what lies beside a form: 2.39:1, 16:9, 1:1, …"},
    {Action::next_image, GLFW_KEY_N, kNone, "N", "Picture", "Next image between passes", true},
    {Action::previous_image, GLFW_KEY_N, kShift, "Shift+N", "Picture", "Image between passes before", true},
    {Action::result_image, GLFW_KEY_BACKSPACE, kNone, "Backspace", "Picture", "The result again"},
    {Action::scope, GLFW_KEY_H, kNone, "H", "Picture", "Scopes: histogram, waveform, parade, vectorscope, all"},
    {Action::proxy, GLFW_KEY_P, kShift, "Shift+P", "Picture", "Proxies (half size, or --proxy), whole pictures"},
    {Action::scope_scale, GLFW_KEY_H, kShift, "Shift+H", "Picture", "Levels of scopes: codes, linear, stops"},
    {Action::clear_region, GLFW_KEY_H, kControl, "Ctrl+H", "Picture", "No region (Ctrl+drag makes one)"},

    {Action::fit, GLFW_KEY_F, kNone, "F", "View", "Fit the picture into the window"},
    {Action::one_to_one, GLFW_KEY_1, kNone, "1", "View", "One pixel for one pixel"},
    {Action::zoom_in, GLFW_KEY_EQUAL, kNone, "+", "View", "Zoom in (also the wheel, at the pointer)", true},
    {Action::zoom_in, GLFW_KEY_EQUAL, kShift, "+", "View", "Zoom in", true},
    {Action::zoom_in, GLFW_KEY_KP_ADD, kNone, "+", "View", "Zoom in", true},
    {Action::zoom_out, GLFW_KEY_MINUS, kNone, "-", "View", "Zoom out", true},
    {Action::zoom_out, GLFW_KEY_KP_SUBTRACT, kNone, "-", "View", "Zoom out", true},
    {Action::pan_left, GLFW_KEY_LEFT, GLFW_MOD_ALT, "Alt+Left", "View", "What lies left of the window's part", true},
    {Action::pan_right, GLFW_KEY_RIGHT, GLFW_MOD_ALT, "Alt+Right", "View", "… right of it", true},
    {Action::pan_up, GLFW_KEY_UP, GLFW_MOD_ALT, "Alt+Up", "View", "… above it", true},
    {Action::pan_down, GLFW_KEY_DOWN, GLFW_MOD_ALT, "Alt+Down", "View", "… below it", true},
    {Action::smooth, GLFW_KEY_M, kNone, "M", "View", "Magnified: squares, or a linear way from pixel to pixel"},
    {Action::compare, GLFW_KEY_W, kNone, "W", "View", "Wipe: off, before and after, other preset"},
    {Action::turn_wipe, GLFW_KEY_W, kShift, "Shift+W", "View", "Turn the wipe"},
    {Action::flip, GLFW_KEY_E, kNone, "E", "View", "The other preset (else what went in) in its place, and back"},
    {Action::side_by_side, GLFW_KEY_V, kNone, "V", "View", "Both side by side"},
    {Action::difference, GLFW_KEY_D, kNone, "D", "View",
     "Their difference (the exposure of the view makes it stronger)"},

    {Action::reload, GLFW_KEY_F5, kNone, "F5", "Preset", "Look at the files now"},
    {Action::copy_message, GLFW_KEY_C, kControl, "Ctrl+C", "Preset", "Copy the error message"},
    {Action::edit_file, GLFW_KEY_F4, kNone, "F4", "Preset",
     "Open the line of the error in $AFTERGLOW_EDITOR; again: of the next one"},
    {Action::undo, GLFW_KEY_Z, kControl, "Ctrl+Z", "Preset", "Undo", true},
    {Action::redo, GLFW_KEY_Z, kBoth, "Ctrl+Shift+Z", "Preset", "Redo", true},
    {Action::redo, GLFW_KEY_Y, kControl, "Ctrl+Y", "Preset", "Redo", true},
    {Action::keep_1, GLFW_KEY_1, kBoth, "Ctrl+Shift+1", "Preset", "Keep stack and settings as snapshot 1"},
    {Action::keep_2, GLFW_KEY_2, kBoth, "Ctrl+Shift+2", "Preset", "… as snapshot 2"},
    {Action::keep_3, GLFW_KEY_3, kBoth, "Ctrl+Shift+3", "Preset", "… as snapshot 3"},
    {Action::recall_1, GLFW_KEY_1, kControl, "Ctrl+1", "Preset", "Stack and settings of snapshot 1 again"},
    {Action::recall_2, GLFW_KEY_2, kControl, "Ctrl+2", "Preset", "… of snapshot 2"},
    {Action::recall_3, GLFW_KEY_3, kControl, "Ctrl+3", "Preset", "… of snapshot 3"},
    {Action::save, GLFW_KEY_S, kControl, "Ctrl+S", "Preset", "Write the changed settings into the preset"},

    {Action::browse_presets, GLFW_KEY_O, kControl, "Ctrl+O", "Preset", "Open a preset, or with Shift+Enter as B"},
    {Action::save_as, GLFW_KEY_S, kBoth, "Ctrl+Shift+S", "Preset",
     "Write the preset to another file, and go on with that"},
    {Action::undo_save, GLFW_KEY_S, kControl | GLFW_MOD_ALT, "Ctrl+Alt+S", "Preset",
     "The preset's file as it was before the last save"},
    {Action::reset_all, GLFW_KEY_BACKSPACE, kControl, "Ctrl+Backspace", "Preset",
     "Stack and settings as the file has them"},
    {Action::search, GLFW_KEY_F, kControl, "Ctrl+F", "Preset", "Search settings"},

    {Action::add_effect, GLFW_KEY_A, kControl, "Ctrl+A", "Stack", "Add an effect"},
    {Action::next_entry, GLFW_KEY_PAGE_DOWN, kNone, "PageDown", "Stack", "Choose the next effect (also a click)", true},
    {Action::previous_entry, GLFW_KEY_PAGE_UP, kNone, "PageUp", "Stack", "Choose the effect before", true},
    {Action::entry_earlier, GLFW_KEY_UP, kControl, "Ctrl+Up", "Stack", "The chosen effect runs earlier"},
    {Action::entry_later, GLFW_KEY_DOWN, kControl, "Ctrl+Down", "Stack", "The chosen effect runs later"},
    {Action::duplicate_entry, GLFW_KEY_D, kControl, "Ctrl+D", "Stack", "A copy behind it"},
    {Action::remove_entry, GLFW_KEY_DELETE, kNone, "Delete", "Stack", "Remove it"},
    {Action::toggle_entry, GLFW_KEY_E, kControl, "Ctrl+E", "Stack", "Switch it off or on"},
    {Action::copy_settings, GLFW_KEY_C, kBoth, "Ctrl+Shift+C", "Stack", "Copy its settings"},
    {Action::paste_settings, GLFW_KEY_V, kBoth, "Ctrl+Shift+V", "Stack", "Paste them into the chosen effect"},

    {Action::panel, GLFW_KEY_TAB, kNone, "Tab", "Window", "Settings panel"},
    {Action::transport, GLFW_KEY_T, kNone, "T", "Window", "Transport bar"},
    {Action::next_pane, GLFW_KEY_F6, kNone, "F6", "Window",
     "The keyboard goes to the panel, the bar, back to the picture"},
    {Action::item_menu, GLFW_KEY_F10, kShift, "Shift+F10", "Window",
     "There: what a right click does to the chosen item"},
    {Action::item_menu, GLFW_KEY_MENU, kNone, "Menu", "Window", "There: what a right click does to the chosen item"},
    {Action::stats, GLFW_KEY_S, kShift, "Shift+S", "Window", "Frame times and reload latency"},
    {Action::full_screen, GLFW_KEY_F11, kNone, "F11", "Window", "Full screen"},
    {Action::screenshot, GLFW_KEY_F12, kNone, "F12", "Window", "Write the window's contents to a PNG file"},
    {Action::export_frame, GLFW_KEY_S, kNone, "S", "Window",
     "Write the frame, whole and full size, as --export says (default: EXR)"},
    {Action::export_range, GLFW_KEY_R, kControl, "Ctrl+R", "Window",
     "Write the frames of the range as a sequence or a video"},
    {Action::print_keys, GLFW_KEY_P, kControl, "Ctrl+P", "Window", "Write this sheet as a page to print"},
    {Action::help, GLFW_KEY_F1, kNone, "F1", "Window", "This sheet"},
    {Action::help, GLFW_KEY_SLASH, kShift, "?", "Window", "This sheet"},
    {Action::escape, GLFW_KEY_ESCAPE, kNone, "Esc", "Window", "Close the sheet, else leave full screen"},
    {Action::quit, GLFW_KEY_Q, kNone, "Q", "Window", "Quit"},
    {Action::quit, GLFW_KEY_Q, kControl, "Ctrl+Q", "Window", "Quit"},
};

}  // namespace

std::span<const Shortcut> shortcuts() { return kShortcuts; }

std::optional<Action> action_of(const KeyPress& press) {
  for (const Shortcut& shortcut : kShortcuts) {
    if (shortcut.key != press.key || shortcut.mods != press.mods) continue;
    if (press.repeat && !shortcut.repeats) return std::nullopt;
    return shortcut.action;
  }
  return std::nullopt;
}

std::string keys_of(Action action) {
  std::string out;
  for (const Shortcut& shortcut : kShortcuts) {
    if (shortcut.action != action || out == shortcut.keys) continue;
    out += (out.empty() ? "" : " or ") + std::string(shortcut.keys);
  }
  return out;
}

}  // namespace afterglow
