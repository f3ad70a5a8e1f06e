// SPDX-License-Identifier: MIT
// What the programme found, for people and for other programs.
#pragma once

#include <functional>
#include <string>

#include "stress/growth.h"
#include "stress/programme.h"

namespace afterglow::stress {

/// Trials that other processes made otherwise.
struct ProcessCheck {
  std::string how;  ///< "LP_NUM_THREADS=1"
  std::uint64_t compared = 0;
  std::vector<std::uint64_t> different;  ///< numbers of trials
};

/// A subject of which nothing was tried: every look that it was given did nothing.
struct NeverActive {
  std::string subject;
  std::uint64_t trials = 0;
  std::string reason;
  std::string text() const;  ///< "film was never active in 12 trials: no file"
};
/// Of subjects that had `enough(subject)` trials.
std::vector<NeverActive> never_active(const Summary& summary,
                                      const std::function<std::uint64_t(const std::string& subject)>& enough);

struct StressReport {
  std::string version, device, driver;
  std::uint64_t seed = 0;
  Summary summary;
  std::vector<ProcessCheck> processes;
  std::vector<GrowthRow> growth;
  std::vector<NeverActive> never_active;
  /// Nothing failed anywhere, and everything was tried.
  bool clean() const;
};

/// Cases and failures by check, with what came nearest to its bound; then findings, other processes, growth of errors.
std::string report_text(const StressReport& report);
std::string report_json(const StressReport& report);

/// "NUMBER HASH" lines, as another process is asked for them. Errors (other): a line that is none.
std::string digests_text(const std::map<std::uint64_t, Hash>& digests);
Result<ProcessCheck> compare_digests(const std::string& how, const std::map<std::uint64_t, Hash>& own,
                                     const std::string& theirs);

}  // namespace afterglow::stress
