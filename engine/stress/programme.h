// SPDX-License-Identifier: MIT
// The programme that tries to break Afterglow: trial after trial, check after check; what fails is made small and kept.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "stress/reproducer.h"
#include "stress/shrink.h"
#include "stress/trial.h"

namespace afterglow::stress {

/// Of one check, or of one check of one subject.
struct Tally {
  std::uint64_t cases = 0, failures = 0;
  double worst = 0, allowed = 0;  ///< the outcome that came nearest to what is allowed, or went beyond
  void add(const Outcome& outcome);
};

/// Something that does not hold.
struct Finding {
  std::string subject, check, stack, picture, what;
  Size size;  ///< after shrinking
  std::uint64_t trial = 0;
  int tries = 0;                 ///< that shrinking took
  std::filesystem::path folder;  ///< of the reproducer; empty: none was asked for
};

struct ProgrammeOptions {
  std::uint64_t seed = 1;
  std::uint64_t cases = 0;             ///< ends after so many; 0: no limit
  std::optional<std::uint64_t> trial;  ///< the trial of this number alone
  double seconds = 0;         ///< ends after so long; 0: no limit. Without both limits: one round over all looks
  std::filesystem::path out;  ///< reproducers go here; empty: none are kept
  std::string version;        ///< of the program, for reproducers
  int digests_every = 8;      ///< every so many trials its results are hashed, for other processes to compare
  int kept_per_kind = 2;      ///< findings of one subject and check that are shrunk and kept; the others are counted
};

/// How often the looks of a subject did anything.
struct Activity {
  std::uint64_t trials = 0, active = 0;
  std::string reason;  ///< why the last one did not
};

struct Summary {
  std::uint64_t trials = 0, cases = 0, failures = 0, refused = 0;
  double seconds = 0;
  std::map<std::string, Tally> checks;
  std::map<std::string, std::map<std::string, Tally>> subjects;  ///< by subject and check
  std::map<std::string, Activity> activity;                      ///< by subject
  std::vector<Finding> findings;
  std::map<std::uint64_t, Hash> digests;  ///< by trial
  bool interrupted = false;
};

/// Called before each trial; an error ends the programme (ErrorKind::interrupted: with the summary so far).
using Step = std::function<Result<void>(const Summary& so_far)>;
/// Called for each new finding.
using Report = std::function<void(const Finding&)>;

/// Errors: io (a folder that cannot be written), device, and those of `step` but for interrupted.
Result<Summary> run_programme(Harness& harness, const Trials& trials, const ProgrammeOptions& options,
                              Diagnostics& diagnostics, const Step& step, const Report& report);

/// A hash of all results of a trial, in full and half floats: the same in every process. Errors: as Harness::run.
Result<Hash> digest_of(Harness& harness, const Trial& trial, Diagnostics& diagnostics);

/// What is tried on a picture of a trial, as the programme tries it. Errors: io.
Result<Situation> situation_of(const Trial& trial, const PictureSpec& spec, Diagnostics& diagnostics);

}  // namespace afterglow::stress
