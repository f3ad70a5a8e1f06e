// SPDX-License-Identifier: MIT
// The options of `afterglow farm`, declared and understood: those of `run`, and what is asked of the scheduler.
#pragma once

#include <string>
#include <vector>

#include "apps/run_arguments.h"
#include "farm/job.h"

namespace afterglow {

struct FarmArguments {
  RunArguments run;
  int chunk = 0;  ///< frames; 0: chosen
  farm::Needs needs;
  std::string jobs;  ///< FILE.json
  bool dry_run = false, wait = false, all = false;
  std::vector<const CLI::Option*> run_options;  ///< those of `run` that chunks get
  CLI::App* app = nullptr;

  void add(CLI::App& command);
  /// status, report, cancel, …; empty: a look to submit.
  std::string word() const;
  /// The words of `run` that were given, but for the inputs and --frames, with the look's files as they lie in the
  /// pack of `folder`. `preset` is the look's file.
  std::vector<std::string> packed_words(const std::filesystem::path& preset, const std::filesystem::path& folder) const;
  /// Whether that option is among the arguments.
  bool gives(const std::string& option) const { return app->get_option(option)->count() > 0; }
  /// What is given besides a look, where a word stands in its place. Errors: usage.
  Result<void> check_word() const;

 private:
  Result<void> check_options_of(const std::string& word) const;
};

/// What may stand in the place of a look: status, report, …
std::vector<std::string> farm_words();

/// The request that words of `run` stand for. Errors: usage, script.
Result<BatchRequest> request_of_words(std::vector<std::string> words);

}  // namespace afterglow
