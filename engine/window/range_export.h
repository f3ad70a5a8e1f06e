// SPDX-License-Identifier: MIT
// Frames of the range written as a sequence or a video, as `afterglow run` would write them: with the look as it is
// when it begins, on a device of its own, beside the playing.
#pragma once

#include <atomic>
#include <filesystem>
#include <future>
#include <mutex>
#include <optional>
#include <string>

#include "batch/batch_run.h"
#include "play/player.h"
#include "window/ui.h"

namespace afterglow {

/// What an export goes by besides the player.
struct ExportSetup {
  std::filesystem::path preset;
  DeviceOptions device;
  StackOptions stack;
  std::filesystem::path to;  ///< as --export says it; empty: nothing was said
};

/// Drawing thread alone; frames are made and written on threads of their own.
class RangeExport {
 public:
  RangeExport(ExportSetup setup, Diagnostics& diagnostics) : setup_(std::move(setup)), diagnostics_(diagnostics) {}
  /// Cancels what is under way and waits for the frame that is being made.
  ~RangeExport() { cancel(); }

  /// Another preset is played from here on.
  void preset_opened(const std::filesystem::path& preset);
  /// In each turn: follows the look, so that an export begins with the last good one; tells what has come of it.
  void poll(Player& player, Ui& ui);
  /// The name that is proposed: of the range's frames, in the folder of the call; after a failure the same once more.
  std::string proposed(Player& player) const;
  /// The frames that would be written, for people: "frames 3–12 (10)".
  std::string range_text(Player& player) const;
  /// The first file that would be written over, if there is one.
  std::optional<std::filesystem::path> in_the_way(Player& player, const std::string& output) const;
  /// Begins; one at a time. Errors, also later ones, stand in the window until they are dismissed.
  void begin(Player& player, Ui& ui, const std::string& output);
  bool busy() const { return running_.valid(); }
  /// The last one was neither cancelled nor failed.
  bool whole() const { return retry_.empty() && !cancelled_; }
  /// Ends it before its next frame: what is written is whole, and a video that is not is taken away.
  void cancel() { cancelled_ = true; }
  /// "frame 3 of 12 to out.mp4"; for who asks before closing.
  std::string state() const;
  /// How high `draw` wants to be; 0: nothing is to be seen.
  float height(const Ui& ui, float width) const;
  /// A bar with a button that cancels, or why there is none any more, as a window at this place.
  void draw(const Ui& ui, ImVec2 place, ImVec2 size);

 private:
  Result<BatchRequest> request(Player& player, const std::string& output) const;
  Result<void> run(const BatchRequest& request);
  void draw_bar(const Ui& ui);
  void draw_failure(const Ui& ui);

  ExportSetup setup_;
  Diagnostics& diagnostics_;
  std::uint64_t generation_ = 0;
  std::optional<std::string> look_;  ///< the preset's file when the last good look was built
  std::string output_;
  std::string failure_;      ///< of the last export, until it is dismissed
  std::string retry_;        ///< its name, when it failed
  std::string first_error_;  ///< of its frames; while it runs, of its thread alone
  std::atomic<bool> cancelled_ = false;
  std::atomic<std::size_t> done_ = 0, total_ = 0;
  std::future<Result<void>> running_;  // last: it ends before what it uses goes
};

}  // namespace afterglow
