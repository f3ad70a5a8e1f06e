// SPDX-License-Identifier: MIT
// What the preset's file says where the panel says something else, and whether that is still what the change was made
// from.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "window/panel_port.h"

namespace afterglow {

/// The value of the preset itself, without the panel's. None: nobody knows (enabled, arguments, unknown settings).
std::optional<SettingValue> base_value(const Build& build, const std::string& entry, const std::string& setting);
/// As far as settings are told apart: numbers as floats.
bool same_value(const SettingValue& a, const SettingValue& b);

/// A setting that was changed in the panel, and since then in the file.
struct EditConflict {
  std::string entry, setting;
  SettingValue was, now;  ///< of the file: when the panel changed it, and now
};

/// Drawing thread alone.
class EditBases {
 public:
  /// In each turn.
  void follow(PanelPort& port);
  const EditConflict* find(const std::string& entry, const std::string& setting) const;
  /// The panel's value stays, over what the file says now.
  void keep(const std::string& entry, const std::string& setting);
  /// What was changed from what, of another stack.
  void forget() { bases_.clear(); }
  /// The file is about to say this: that is no conflict.
  void expect(const std::string& entry, const std::string& setting, const SettingValue& value);

 private:
  struct Base {
    std::string entry, setting;
    SettingValue value;
  };
  Base* base_of(const std::string& entry, const std::string& setting);
  std::vector<Base> bases_;
  std::vector<EditConflict> conflicts_;
};

}  // namespace afterglow
