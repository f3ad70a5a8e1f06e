// SPDX-License-Identifier: MIT
// The panel's changes of the stack: into the preset's text, as a step that can be undone, and what happens when the
// file changes meanwhile.
#pragma once

#include <deque>
#include <filesystem>
#include <future>
#include <optional>
#include <string>

#include "edit/stack_edit.h"
#include "edit/write_back.h"
#include "window/panel_port.h"

namespace afterglow {

/// Drawing thread alone; scripts run on a thread of its own, so that playing goes on.
class PanelStack {
 public:
  PanelStack(std::filesystem::path preset, PresetOptions options)
      : file_(std::move(preset)), options_(std::move(options)) {}

  /// One behind the other: those that wait follow their entries when these get other names.
  void begin(StackEdit edit);
  bool busy() const { return running_.valid() || !waiting_.empty(); }
  /// Takes what has come of it; in each turn. `may_begin`: the text is not being written. True when there is something
  /// new to tell.
  bool poll(PanelPort& port, bool may_begin = true);
  /// Blocks until `poll` has something to take. For tests.
  void wait() const {
    if (running_.valid()) running_.wait();
  }

  /// Of the last one: "glow was added"; why not when it failed.
  const std::string& message() const { return message_; }
  bool failed() const { return failed_; }
  void dismiss() { failed_ = false; }
  /// The entry that it was about, by its name now; once. Empty: none, or it is gone.
  std::string take_shown() { return std::exchange(shown_, {}); }
  /// What an entry is called since the last change, by its name before.
  std::string called_now(const std::string& before) const;

  /// What is to be written in place of the file's text; none: the stack is the file's.
  std::optional<WorkingText> working(PanelPort& port) const;
  /// The file has another text than the changed stack was made from.
  bool conflict() const { return conflict_; }
  void keep();                 ///< the panel's stack, over what the file says now
  void take(PanelPort& port);  ///< the file's stack; a step of the history
  /// The program itself has written the file: stacks that were made beside the text before are beside this one now.
  void wrote(const std::string& before, std::string after);

 private:
  struct Outcome {
    std::optional<Error> error;
    StackRewrite rewrite;
    std::string base;  ///< of the file
  };
  Outcome run(const StackEdit& edit, const StackText& text) const;
  void look_at_file(PanelPort& port);
  const std::string& base_of(const StackText& text) const;
  void replace_base(const std::string& before, std::string after);
  static std::string told(const StackEdit& edit, const std::string& entry);

  std::filesystem::path file_;
  PresetOptions options_;
  /// A changed stack of the history or of a snapshot, and the file's text beside which it was made.
  struct Made {
    StackText text, base;
  };
  std::vector<Made> made_;
  std::string base_;  ///< of stacks that are not among them: the file's texts before a save
  std::optional<std::filesystem::file_time_type> seen_;  ///< of the file, when it was compared last
  StackText looked_at_;                                  ///< what it was compared for
  std::string now_;                                      ///< the file's text where that is another
  bool conflict_ = false;
  std::string message_, shown_;
  std::vector<std::pair<std::string, std::string>> renamed_;  ///< by the last change
  bool failed_ = false;
  void start(PanelPort& port);
  const std::string* name_after(const std::string& before) const;
  void follow();
  std::deque<StackEdit> waiting_;
  StackEdit edit_;
  StackText made_from_;
  std::future<Outcome> running_;  // last: it ends before what it uses goes
};

}  // namespace afterglow
