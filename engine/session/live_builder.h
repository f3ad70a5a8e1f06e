// SPDX-License-Identifier: MIT
// The thread on which a LiveStack's builds happen. Internal to the room.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "core/file_record.h"
#include "core/stopwatch.h"
#include "exec/cpu/warm_up.h"
#include "session/followed_files.h"
#include "session/live.h"

namespace afterglow {

/// What stacks are built for.
struct LiveRequest {
  std::optional<BuildContext> context;  ///< none: scripts alone
  std::optional<DisplayEncoding> encoding;
  std::vector<Override> overrides;
  std::vector<ArgumentValue> arguments;
  std::shared_ptr<const std::string> text;  ///< of the preset; null: its file's
  std::string shown;
  bool for_frame = false;  ///< asked for because of `context` alone; the next build takes it
};

/// What the scripts of one build have said.
struct Heard {
  std::mutex mutex;
  std::vector<std::string> warnings;  ///< in frames too, each once
  std::vector<std::string> notes;     ///< until it was built: a frame may print whatever it likes, each time
  bool built = false;
};

/// A stack with what it needs to live.
struct BuiltStack {
  std::shared_ptr<const int> token;  ///< counts them
  std::shared_ptr<Heard> heard;
  std::unique_ptr<Diagnostics> diagnostics;
  std::unique_ptr<Stack> stack;
  std::shared_ptr<const FileProbes> files{};  ///< that the build has looked at
  bool for_frame = false;                     ///< see LiveRequest
};

/// Builds that have not been taken yet: a stack, and newer scripts for it or for the one that is shown.
struct BuiltParts {
  std::optional<BuiltStack> structure, values;
  BuildTimes times;
  bool for_frame = false;  ///< of the structure that was taken
  std::chrono::steady_clock::time_point done;
  bool any() const { return structure || values; }
};

class LiveBuilder {
 public:
  LiveBuilder(Device& device, std::filesystem::path preset, const LiveOptions& options, Diagnostics& diagnostics);
  ~LiveBuilder();

  // All of these are thread-safe.
  /// Changes what is wanted; with `build` it is built.
  void change(const std::function<void(LiveRequest&)>& apply, bool build);
  void look();    ///< at the files
  void settle();  ///< see LiveStack
  void also_follow(FileProbes looks);
  BuiltParts take();
  void release(BuiltStack stack);  ///< destroys it on the builder's thread
  void forward(const std::function<void(LiveStatus&, LiveStack::Counters&)>& apply);
  LiveStatus status() const;
  std::vector<std::string> wants() const;  ///< see LiveStack
  bool building() const;
  LiveStack::Counters counters() const;

 private:
  /// Why a build is wanted.
  struct Wanted {
    bool files = false, request = false;
    std::optional<Clock::time_point> since;
    bool any() const { return files || request; }
    void note(Clock::time_point when) { since = std::min(since.value_or(when), when); }
  };
  using Until = std::atomic<Clock::rep>;
  /// What the programs of a stack are made for.
  struct Basis {
    std::shared_ptr<const Build> build;
    FrameWork work;
    StackChoice choice;
    /// Would programs that are made for one do for the other, with other values?
    bool serves(const Basis& other) const;
  };

  void run();
  void files_may_differ(Clock::time_point since, bool polled);
  void overtake();
  void work(const Wanted& why, const LiveRequest& request);
  Result<void> build(const LiveRequest& request, BuildTimes& times);
  Result<BuiltStack> load(const LiveRequest& request, const std::shared_ptr<FileRecord>& record,
                          std::optional<Basis>& work, std::vector<std::string>& wants);
  BuiltStack new_stack();
  std::vector<std::string> not_asked(Stack& stack, const LiveRequest& request) const;
  void await_inputs(std::vector<std::string> wants);
  void publish(BuiltStack built, const BuildTimes& times);
  void fail(Error error);
  void give_up(bool for_frame);
  bool starves() const;
  void warm_up(Stack& stack, BuildTimes& times);
  bool overtaken() const;
  void want_look();
  void notify() const;

  const std::shared_ptr<const int> token_ = std::make_shared<const int>();  // every BuiltStack holds it
  Device& device_;
  const std::filesystem::path preset_;
  LiveOptions options_;
  Diagnostics& diagnostics_;

  // Of the builder's thread alone.
  std::optional<Basis> basis_;  ///< of the newest stack that was built
  Clock::time_point published_at_{};
  std::unique_ptr<WarmUp> warm_up_;
  bool may_warm_up_;

  mutable std::mutex mutex_;  // for all below
  std::condition_variable changed_;
  LiveRequest request_;
  Wanted wanted_;
  bool ends_ = false;
  bool builds_ = false;                       ///< busy with a build, not only with letting go of what is dead
  std::uint64_t asked_ = 0, answered_ = 0;    ///< calls of `settle`, and those whose changes are built or have failed
  std::optional<Clock::time_point> gave_up_;  ///< the first build that was, since one came to an end
  std::shared_ptr<Until> until_;              ///< when the script that is running ends at the latest
  Clock::time_point script_began_{};
  BuiltParts parts_;
  std::vector<std::string> wants_;
  std::vector<BuiltStack> dead_;
  LiveStatus status_;
  LiveStack::Counters counters_;

  std::mutex said_mutex_;
  std::set<std::string> said_, noted_;  ///< warnings and notes that were passed on, while each build says them again

  FollowedFiles files_;
  std::thread thread_;
};

}  // namespace afterglow
