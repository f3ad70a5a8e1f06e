// SPDX-License-Identifier: MIT
// Plays footage through a preset that is being edited. One turn after the other is asked for by whoever draws: a
// window, or a command without one.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exec/frame.h"
#include "play/figures.h"
#include "play/finite_watch.h"
#include "play/footage.h"
#include "play/read_ahead.h"
#include "play/scopes.h"
#include "play/setting_edits.h"
#include "play/sound.h"
#include "play/transport.h"
#include "play/view.h"
#include "session/live_session.h"

namespace afterglow {

struct PlayerOptions {
  std::filesystem::path preset;
  std::filesystem::path other_preset;  ///< B of A/B; empty: none
  LiveOptions live;                    ///< of both; its `notify` is called besides the player's own
  FootageOptions footage;
  ReadAheadOptions read_ahead;
  std::optional<double> fps;  ///< else the footage's own, else 24
  LoopMode loop = LoopMode::loop;
  Pacing pacing = Pacing::real_time;
  KernelTiming timing = KernelTiming::none;
  std::optional<SoundOptions> sound;               ///< of videos; none: all is silent
  bool warm_up = true;                             ///< LiveOptions::warm_up of both
  std::optional<FiniteWatchOptions> finite_watch;  ///< of the first preset; none: nobody looks
  std::string show;                                ///< image between passes to show; empty: the result
  std::function<double()> clock;                   ///< seconds, never backwards; empty: the system's steady clock
  std::function<void()> wake;  ///< called on any thread when `step` has something to do before `Step::next`
};

/// What a turn came to.
struct Step {
  bool changed = false;   ///< `images` or `shown` are others than before: draw
  bool reloaded = false;  ///< a new build was taken
  bool timed = false;     ///< `Player::kernel_times` has something new
  bool told = false;      ///< ShownFrame::not_finite is another than before: it is drawn over the same images
  double next = 0;        ///< when the next frame is due, by the player's clock; infinity: not before a `wake`
};

/// What is on screen.
struct ShownFrame {
  int position = -1;  ///< in the footage; −1: nothing yet
  int number = 0;     ///< in its sequence
  bool held = false;  ///< its file is missing; it shows the one before
  std::string name;   ///< of the picture
  Size size;  ///< of the whole picture; where a proxy is shown, of a proxy's pixels as many times as they are smaller
  std::optional<Error> unreadable;  ///< why it could not be read: the picture before stays
  std::optional<Error> failed;      ///< why the stack could not be run on it: the picture before stays
  /// Passes of the first preset that made values that are not finite, in the frame that was looked at last: the first
  /// after each build, and each that stands still. On screen they are 0.
  std::shared_ptr<const FiniteAnswer> not_finite;
};

/// What is known of a frame. Later ones are worse.
enum class FrameState { unread, cached, missing, unreadable };

/// For shaders that show them; see DeviceImages. Null images until there is a picture.
struct PlayerImages {
  DeviceImage source, result;
  std::optional<DeviceImage> other;  ///< B's result
  Size picture;                      ///< of the footage; an image between passes may be smaller
};

/// Values under the cursor, linear.
struct Probe {
  Pixel pixel;
  std::array<float, 4> source{}, result{};
  std::optional<std::array<float, 4>> other;
};

/// Means over a region of the picture, linear.
struct RegionMeans {
  Rect region;
  RegionMean source, result;
  std::optional<RegionMean> other;
};

/// Drawing thread alone, but for `wake`'s callers. The device must outlive it.
class Player {
 public:
  /// A preset that is broken is no error: see LiveStack. Errors: usage, io (footage), device.
  static Result<std::unique_ptr<Player>> open(Device& device, const PlayerOptions& options, Diagnostics& diagnostics);
  ~Player();

  /// One turn: takes what was built, looks which frame is due, runs it when anything about it has changed. Does not
  /// wait for pictures that are being read: the frame before stays, and what was due meanwhile counts as dropped.
  /// Nothing that draws `images` may be in flight. Errors: device.
  Result<Step> step();
  /// Blocks until `step` has something to do or `until` (of the clock that is the system's) has come.
  void wait(double until);
  /// Blocks until the picture that is due has been read and everything that was changed is built. For tests and for
  /// programs that show a fixed number of frames.
  void settle();
  double now() const;

  Transport& transport();
  View& view();
  const Footage& footage() const;
  /// Reads the picture on screen anew, with depth, normals and motion, which looks may ask for that are not played. May
  /// be called on any thread, and when the player is gone. Empty: it has no more than `source` has.
  std::function<Result<Picture>()> reader_with_inputs() const;
  const std::filesystem::path& preset_file() const;
  const std::filesystem::path& other_file() const;  ///< of `other`
  Sound* sound();                                   ///< null without PlayerOptions::sound
  const FootageOptions& footage_options() const;    ///< what `footage` was opened with
  FrameState frame_state(int position) const;
  LiveStack& live();
  LiveStack* other();  ///< null without a second preset
  const ShownFrame& shown() const;
  PlayerImages images() const;
  /// The picture of `shown` as it was read, scene-linear; null: none yet.
  std::shared_ptr<const Picture> source() const;
  /// What runs the first preset: its kernels, memory, what the last frame left out.
  const LiveSession& session() const;

  // Settings over those of the preset (and over --set); they apply with the next turns, through LiveStack.
  void set(const std::string& entry, const std::string& setting, const SettingValue& value);
  void reset(const std::string& entry, const std::string& setting);
  void set_all(const std::vector<SettingEdit>& values);
  void set_stack(const StackChange& change);
  void reset_stack();
  void reset_all();
  bool undo();
  bool redo();
  void take_back();
  /// See SettingEdits::keep and recall.
  void keep_snapshot(int snapshot);
  bool recall_snapshot(int snapshot);
  const SettingEdits& edits() const;
  void end_gesture();
  /// See SettingEdits::rebase.
  void rebase(const std::vector<BaseChange>& changes);
  void rebase(const std::vector<BaseChange>& changes, const TextChange& text);

  /// Blocks until the frame that was shown last is looked at: ShownFrame::not_finite.
  void finish_finite_watch();

  /// See LiveStack::show.
  void show(const std::string& image);
  /// Reads the pictures again.
  void reload_pictures();
  /// Reads pictures at one part in `proxy` of their sides, and runs the look so that lengths are those of the whole.
  /// Zoom, region and place stay. 1: whole pictures.
  void set_proxy(int proxy);
  int proxy() const;
  /// Plays something else; zoom and settings stay. Errors: usage, io; then everything stays as it is.
  Result<void> open_footage(const std::vector<std::string>& inputs);
  /// Another preset in place of the first; its panel edits are forgotten. Errors: io.
  Result<void> open_preset(const std::filesystem::path& preset);
  Result<void> open_other(const std::filesystem::path& preset);

  /// None outside of the picture or without one. Reads one pixel of the result from the device. Errors: device.
  Result<std::optional<Probe>> probe(Pixel pixel);
  enum class Of { source, result, other };
  /// Reads the whole result from the device: only when it is looked at. Of an image of another size than the picture,
  /// the region is what lies under it. Errors: device.
  Result<Scopes> scopes(const ScopeOptions& options = {}, Of of = Of::result);
  /// None without a picture, or where nothing of the region lies in it. Errors: device.
  Result<std::optional<RegionMeans>> means(Rect region);
  /// The frame that is shown, as `afterglow run` would make it, for writing. Of a proxy the whole picture is read and
  /// run for it: nothing that draws `images` may be in flight. Errors: other (nothing is shown), device, io.
  Result<Picture> screenshot();

  /// The window has handed the frame of the last turn to the screen.
  void presented();
  PlayerStats stats() const;
  // Of `stats`, for each frame of an interface: these sort nothing.
  double fps() const;
  /// Shown, or unreadable when they were due.
  std::uint64_t frames_had() const;
  std::uint64_t late() const;
  /// Times kernels one by one: one with every second frame while playing, the others when nothing else is to do. Off at
  /// first.
  void time_kernels(bool on);
  /// What is known of the first preset's kernels, in milliseconds.
  std::vector<KernelTime> kernel_times() const;

 private:
  struct State;
  explicit Player(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace afterglow
