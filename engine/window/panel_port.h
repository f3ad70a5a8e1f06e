// SPDX-License-Identifier: MIT
// What the panel asks of whoever plays: as small as it can be, so that the panel is tested with ImGui and a preset
// alone.
#pragma once

#include <string>
#include <vector>

#include "exec/frame.h"
#include "play/setting_edits.h"
#include "play/view.h"
#include "script/build.h"
#include "session/live.h"

namespace afterglow {

class Player;

/// Drawing thread alone. References hold until the next turn of the player.
class PanelPort {
 public:
  virtual ~PanelPort() = default;
  virtual const Preset* preset() = 0;                 ///< of the stack that is shown; null: there was no good one yet
  virtual const Build* build() = 0;                   ///< what it said about the last frame; null: there was none yet
  virtual LiveStatus status() = 0;                    ///< `building`: `build` is not of the newest files and edits
  virtual const std::vector<Skipped>& skipped() = 0;  ///< effects that the last frame left out, with reasons
  virtual std::vector<KernelTime> times() = 0;        ///< of kernels, as far as they are known

  virtual const SettingEdits& edits() = 0;
  virtual void set(const std::string& entry, const std::string& setting, const SettingValue& value) = 0;
  virtual void reset(const std::string& entry, const std::string& setting) = 0;
  virtual void set_all(const std::vector<SettingEdit>& values) = 0;
  virtual void set_stack(const StackChange& change) = 0;
  virtual void reset_stack() = 0;
  virtual void reset_all() = 0;
  virtual bool undo() = 0;
  virtual bool redo() = 0;
  virtual void take_back() = 0;  ///< see SettingEdits::take_back
  virtual void end_gesture() = 0;
  virtual void rebase(const std::vector<BaseChange>& changes) = 0;  ///< see SettingEdits::rebase
  virtual void rebase(const std::vector<BaseChange>& changes, const TextChange& text) = 0;

  virtual View& view() = 0;
  virtual Rect middle_region() = 0;               ///< a third of the picture, in its middle
  virtual std::vector<std::string> images() = 0;  ///< that can be shown, see LiveStack::images
  virtual std::string shown_image() = 0;
  virtual void show(const std::string& image) = 0;
  virtual bool has_other() = 0;  ///< a second preset, to compare with
};

}  // namespace afterglow
