// SPDX-License-Identifier: MIT
// Keys that set, name and visit markers, and the field for a name.
#pragma once

#include "window/markers.h"
#include "window/name_dialog.h"
#include "window/shortcuts.h"

namespace afterglow {

/// Drawing thread alone.
class MarkKeys {
 public:
  MarkKeys();
  /// True: a field is about to get the keyboard.
  bool act(Player& player, Ui& ui, Action action);
  void draw(Player& player, Ui& ui);
  /// False: nothing was open.
  bool close_windows();
  /// Of what is being played.
  const Markers& markers(Player& player);

 private:
  void go(Player& player, Ui& ui, const std::optional<Marker>& marker, const char* none);
  Markers markers_;
  NameDialog name_;
  int named_ = 0;  ///< position whose marker gets the name
};

}  // namespace afterglow
