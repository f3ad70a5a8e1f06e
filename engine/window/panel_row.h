// SPDX-License-Identifier: MIT
// A row of the panel: a value with its name, where it comes from, and what takes a change back.
#pragma once

#include <string>

#include "window/panel_base.h"
#include "window/ui.h"

namespace afterglow {

struct PanelRow {
  std::string entry;  ///< empty: an argument of the preset
  std::string name;   ///< of the setting: "intensity", "mask.luma.from"
  const SettingSchema& schema;
  SettingValue value;             ///< without the panel's change of it
  const SettingHistory* history;  ///< null: an argument
  bool said = false;              ///< by the preset, or for an argument by --arg
};

/// Within the panel's window.
void draw_row(Ui& ui, PanelPort& port, EditBases& bases, const PanelRow& row);

/// The small button that comes next stands on the line of the last item, where it has room.
void beside(const char* label);
bool small_button(const Ui& ui, const char* label, const char* help, bool enabled = true);

}  // namespace afterglow
