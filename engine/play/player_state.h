// SPDX-License-Identifier: MIT
// What a Player holds; private to this room.
#pragma once

#include <condition_variable>
#include <future>
#include <mutex>
#include <set>

#include "play/footage_watch.h"
#include "play/player.h"
#include "play/shot_watch.h"
#include "play/sound_follower.h"
#include "session/live_session.h"

namespace afterglow {

struct Player::State {
  State(Device& device_in, PlayerOptions options_in, Diagnostics& diagnostics_in)
      : device(device_in), options(std::move(options_in)), diagnostics(diagnostics_in) {}

  Device& device;
  PlayerOptions options;
  Diagnostics& diagnostics;

  // Told by other threads.
  std::mutex mutex;
  std::condition_variable woken;
  bool awake = false;
  FootageNeeds needs;                           ///< of the looks that are there
  std::set<int> unreadable;                     ///< pictures whose last reading failed
  std::shared_ptr<const Footage> read_footage;  ///< that the reader reads of
  std::uint64_t readers = 0;                    ///< that there were: the number of the last one

  std::shared_ptr<const Footage> footage;
  Transport transport{1};
  View view;
  SettingEdits edits;
  Figures figures;

  std::unique_ptr<LiveSession> first, second;
  std::shared_ptr<const ReadPicture> picture;  ///< that the images on the device were made of
  int picture_proxy = 1;                       ///< that it was read at
  ShownFrame shown;
  HostResult result;      ///< what was read back of the first's
  bool dirty = true;      ///< the picture on screen has to be run again
  bool reread = false;    ///< …and so does the one that is being read anew, when it comes
  bool reloaded = false;  ///< builds were taken since the last turn
  std::string told;       ///< the error that was told last
  /// The last frame that was run.
  struct Ran {
    std::int64_t tick = 0;
    double number = 0;
  };
  std::optional<Ran> ran;
  ShotWatch shots{{}};
  bool time_kernels = false;
  int frames_untimed = 0;    ///< since a kernel was timed
  bool second_runs = false;  ///< B was run for what is on screen
  double turn_ended = 0;
  std::vector<int> wanted_for;              ///< position, heading and speed that the wishes were made for
  std::uint64_t measured = 0;               ///< generation of the stack whose first frame was measured
  std::unique_ptr<ReadAhead> ahead;         // its threads use the rest, as that of the next does
  std::unique_ptr<FootageWatch> rendering;  ///< null: files stay as they are
  std::vector<std::future<void>> ending;    ///< those of footage before, whose threads are in the midst of something

  /// What was looked at last.
  struct AskedFinite {
    std::uint64_t build = 0;
    std::weak_ptr<const ReadPicture> picture;
  };
  std::optional<AskedFinite> asked_finite;
  void forget_finite();
  std::set<std::string> told_finite;          ///< passes that were told, since all was well
  std::unique_ptr<FiniteWatch> finite_watch;  ///< null: nobody looks

  std::unique_ptr<Sound> sound;  ///< null: all is silent
  SoundFollower sound_follower;

  double now() const { return options.clock(); }
  double usual_fps() const { return options.fps.value_or(footage->fps().value_or(24)); }
  void wake();
  LiveOptions live_options(const std::vector<Override>& overrides);
  void begin_reading();
  void end_reading();
  void take_footage();
  Result<void> open_row(FootageOptions wanted);
  std::shared_ptr<const Footage> readable(std::uint64_t reader);
  FootageNeeds needs_now();
  void want_pictures();
  void take_builds();
  void tell_errors();
  void watch_finite();
  bool take_finite();
  void ask_frames(Preset& preset) const;
  bool wants_more() const;
  std::set<std::string> awaited() const;
  bool was_asked(const Picture& read) const;
  void follow_needs();
  Result<bool> show_due(double now);
  Result<bool> time_a_kernel(bool changed, Step& step);
  Result<bool> run(const std::shared_ptr<const ReadPicture>& read, const Transport::Due& due);
  BuildContext context(int position, int proxy) const;
  Result<Picture> whole_frame();
  void mend(Image& color);
  void apply_edits();
  void take_the_place_of_given(std::vector<BaseChange>& changes);
  struct Looked;
  Result<Looked> look(Of of);  ///< there is a picture, and what is asked for has run
};

}  // namespace afterglow
