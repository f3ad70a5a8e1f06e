// SPDX-License-Identifier: MIT
// What the tests of faults share: the program run with one fault at a time, at every place where it can strike or at
// some of them.
#pragma once

#include <functional>
#include <set>

#include "cli_test.h"

namespace afterglow::test {

using Environment = std::map<std::string, std::string>;

/// What may go wrong, as the libraries beside this file understand it.
struct Fault {
  std::string name;  ///< for messages
  Environment environment;
};
Fault vulkan_fault(const std::string& code);  ///< host, device, lost
Fault memory_fault();
Fault file_fault(const std::string& kind, const fs::path& root);
Fault thread_fault();  ///< places are numbers of threads that run at a time

/// presets/neon_night.lua.
inline std::string neon_night() { return preset("neon_night.lua").string(); }

/// A look whose frames need those before them.
inline constexpr const char* kLooksBack =
    "local fx = require \"afterglow\"\n"
    "return fx.stack { fx.auto_exposure {}, fx.bloom { intensity = 0.5 }, fx.tone_mapping { mode = \"aces\" } }\n";

class FaultTest : public CliTest {
 protected:
  /// How many places a fault can strike during this command. The command must succeed.
  long places(const std::vector<std::string>& arguments, const Fault& fault) const;
  /// Those of them that are worth a strike each, in their order, where the fault's library can tell: of allocations,
  /// the first and the last one by each way through the program's functions. The last of all in any case.
  std::vector<long> distinct_places(const std::vector<std::string>& arguments, const Fault& fault) const;
  /// `most` of these places, spread evenly. The environment may say otherwise: AFTERGLOW_FAULTS=every, a number, or
  /// FROM-TO, which is those in a row.
  static std::vector<long> some(const std::vector<long>& places, long most);
  static std::vector<long> some(long last, long most);  ///< of [1, last]
  Outcome run_with(const std::vector<std::string>& arguments, const Fault& fault, long place) const;

  /// Keeps the bytes of what the last command has made (files of the test's folder that match), and removes them.
  void take_reference(const std::vector<std::string>& outputs);
  /// Every output that is there has the bytes of the reference; returns how many are.
  int expect_whole_or_absent() const;
  void remove_outputs() const;
  /// No half-written file is left beside the outputs.
  void expect_nothing_left_over() const;

  /// Ended as the house ends: done, or with a code of its own and a message that begins as errors do.
  static void expect_clean_end(const Outcome& outcome);

  Environment environment_;  ///< of all runs
  std::string program_;      ///< that is run; empty: the built one

 private:
  RunOptions options_at(const Fault& fault, long place) const;
  /// Once without a fault: what is compiled for the first time is compiled on another device too, with calls of its
  /// own. What it makes goes.
  void fill_caches(const std::vector<std::string>& arguments) const;
  std::map<std::string, std::string> reference_;
};

}  // namespace afterglow::test
