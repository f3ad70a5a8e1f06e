// SPDX-License-Identifier: MIT
// A stack that follows its files: edits are built on a thread of their own and taken between frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "core/file_record.h"
#include "core/result.h"
#include "core/watch.h"
#include "gpu/device.h"
#include "session/display_encoding.h"
#include "session/stack.h"

namespace afterglow {

struct LiveOptions {
  StackOptions stack;  ///< its overrides are the first of `LiveStack::set_overrides`
  /// See Stack::use: source and result will be a Renderer's.
  bool own_images = true;
  /// New kernels are drawn with on another device before they are taken, where the driver would compile them in their
  /// first frame else (exec/cpu/warm_up.h).
  bool warm_up = false;
  bool follow = true;  ///< watch the files; false: only `LiveStack::reload` looks at them
  WatchOptions watch;
  /// The host reads inputs as looks want them (LiveStack::wants): a look that wants more than the context was read for
  /// (BuildContext::asked) waits for a context that was, and the one before it runs on.
  bool inputs_follow = false;
  /// Called on other threads when `update` would change something or `status` has changed: to wake a drawing thread
  /// that sleeps. Must not call back into the LiveStack.
  std::function<void()> notify;
};

/// Where the time of a build went, in milliseconds. What a build did not do took none.
struct BuildTimes {
  enum class Kind {
    none,       ///< nothing was built yet
    values,     ///< values alone: no shader, pipeline or memory was touched
    structure,  ///< shaders, passes or images
    frame,      ///< as before, because the preset has other passes in this frame: no edit
  };
  Kind kind = Kind::none;
  double notice = 0;    ///< from the change on disk (or the call) until the build began
  double script = 0;    ///< the preset, its effects and the graph
  double shader = 0;    ///< GLSL to SPIR-V, and memory for images
  double pipeline = 0;  ///< pipelines
  double warm_up = 0;   ///< the driver's own compiling, beside the drawing thread
  double wait = 0;      ///< until `update` took it
  int kernels_compiled = 0, pipelines_made = 0;
};

/// A snapshot.
struct LiveStatus {
  std::optional<Error> error;    ///< of the newest build; none when it is good
  std::string source_line;       ///< the line that `error` names, as the file had it; or empty
  std::uint64_t generation = 0;  ///< of the stack that is shown; grows with each change that `update` took; 0: none yet
  bool building = false;         ///< or about to
  std::vector<std::string> warnings;  ///< of the build that is shown; overrides that do not fit are among them
  std::vector<std::string> notes;     ///< of that build: what its scripts have printed, but not in frames since
  BuildTimes times;                   ///< of the last build that `update` took
  std::string watching;  ///< how files are followed: "inotify", "polling every 500 ms: …", "" when they are not

  /// The error as it is printed, with the offending source line below it; empty without one.
  std::string error_text() const;
};

/// Drawing thread alone, but for `status`. A build that fails leaves the last good stack where it is. Builds that
/// files, overrides or contexts have overtaken are given up. The device must outlive it.
class LiveStack {
 public:
  /// A preset that is broken or not there yet is no error: `stack` is null and `status().error` says why, until a good
  /// one appears. The first build happens in this call, as far as it needs no pictures. Errors: io (calibration file).
  static Result<std::unique_ptr<LiveStack>> open(Device& device, const std::filesystem::path& preset,
                                                 const LiveOptions& options, Diagnostics& diagnostics);
  /// Ends a script that is running; waits for nothing but a shader that is being compiled.
  ~LiveStack();

  /// The last good one, or null. Stays as it is until `update`.
  Stack* stack();
  /// Takes what has been built since, all of it or nothing; true when `stack` has changed. Cheap when there is nothing.
  /// No submission that uses `stack` may be in flight.
  bool update();

  /// Grows whenever `update` has put another stack in the place of the one before, programs and all.
  std::uint64_t stacks_taken() const;

  /// What the next frames look like: from the first call on, builds are complete with shaders, pipelines and memory
  /// for such a frame. Call it for each frame; cheap when nothing but the time has changed.
  void set_context(const BuildContext& context, const std::optional<DisplayEncoding>& encoding = {});
  /// Builds for the frame that `set_context` said last, whose structure is another one than `stack` has programs for
  /// (ProgramCache::has). Those it has stay as spare ones.
  void build_for_frame();
  /// Whether something is being built, or about to be.
  bool building() const;
  /// `--set` and the panel's: all of them, later ones win. Those that do not fit the preset are left out with a
  /// warning, and come back when it fits again.
  void set_overrides(std::vector<Override> overrides);
  /// The same with `--arg` and the panel's arguments, and with the preset's text where it is another than its file's
  /// (null: the file's), in one build.
  void set_overrides(std::vector<Override> overrides, std::vector<ArgumentValue> arguments,
                     std::shared_ptr<const std::string> text = {});
  const std::vector<Override>& overrides() const;
  /// The image that takes the result's place: "" for the result itself, "source", or the name of an image of the graph
  /// ("glow.down[2]"). While the graph has no such image the result is shown and `status().warnings` says so.
  void show(const std::string& image);
  const std::string& shown() const;
  /// What `show` knows in the frame that was prepared last: "source", then the images of all passes in their order.
  std::vector<std::string> images() const;
  /// Looks at the files now, whatever the watcher says (for a reload key, and where `follow` is false).
  void reload();

  /// What a frame has looked at (Build::files) is followed as well: at another time a preset may use shaders that the
  /// build has not met. Cheap when it is the same value as the last time.
  void also_follow(const std::shared_ptr<const FileProbes>& looks);

  /// Any thread.
  LiveStatus status() const;
  /// Inputs that the look that waits for them wants. Empty: none waits.
  std::vector<std::string> wants() const;
  /// Blocks until every change so far is built (`update` has not taken it yet) or has failed; what changes from now on
  /// is not waited for. For tests and for programs that render a fixed number of frames.
  void settle();

  struct Counters {
    std::uint64_t builds = 0;    ///< begun
    std::uint64_t given_up = 0;  ///< overtaken by later changes
    std::uint64_t failed = 0;
    std::uint64_t values = 0;      ///< taken that touched no shader, pipeline or memory
    std::uint64_t structures = 0;  ///< taken that did
    std::uint64_t for_frames = 0;  ///< of these, for frames whose structure was another one
    std::uint64_t compiled = 0;    ///< kernels that the compiler made: neither memory nor disk had them
    std::uint64_t pipelines_alive = 0;
    std::uint64_t pipelines = 0;  ///< made so far
    std::uint64_t images = 0;     ///< between kernels, alive now
    std::uint64_t stacks = 0;     ///< alive now: shown, built, not yet released
  };
  Counters counters() const;  ///< any thread

 private:
  struct State;
  explicit LiveStack(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace afterglow
