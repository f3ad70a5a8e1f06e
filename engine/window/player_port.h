// SPDX-License-Identifier: MIT
// The player as the panel sees it.
#pragma once

#include "play/player.h"
#include "window/panel_port.h"

namespace afterglow {

/// Drawing thread alone. The player must outlive it.
class PlayerPort final : public PanelPort {
 public:
  explicit PlayerPort(Player& player) : player_(player) {}

  const Preset* preset() override;
  const Build* build() override;
  LiveStatus status() override;
  const std::vector<Skipped>& skipped() override;
  std::vector<KernelTime> times() override { return player_.kernel_times(); }

  const SettingEdits& edits() override { return player_.edits(); }
  void set(const std::string& entry, const std::string& setting, const SettingValue& value) override {
    player_.set(entry, setting, value);
  }
  void reset(const std::string& entry, const std::string& setting) override { player_.reset(entry, setting); }
  void set_all(const std::vector<SettingEdit>& values) override { player_.set_all(values); }
  void set_stack(const StackChange& change) override { player_.set_stack(change); }
  void reset_stack() override { player_.reset_stack(); }
  void reset_all() override { player_.reset_all(); }
  bool undo() override { return player_.undo(); }
  void take_back() override { player_.take_back(); }
  bool redo() override { return player_.redo(); }
  void end_gesture() override { player_.end_gesture(); }
  void rebase(const std::vector<BaseChange>& changes) override { player_.rebase(changes); }
  void rebase(const std::vector<BaseChange>& changes, const TextChange& text) override {
    player_.rebase(changes, text);
  }

  View& view() override { return player_.view(); }
  Rect middle_region() override;
  std::vector<std::string> images() override { return player_.live().images(); }
  std::string shown_image() override { return player_.live().shown(); }
  void show(const std::string& image) override { player_.show(image); }
  bool has_other() override { return player_.other() != nullptr; }

 private:
  Player& player_;
  std::vector<Skipped> skipped_;
};

}  // namespace afterglow
