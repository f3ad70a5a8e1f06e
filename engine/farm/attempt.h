// SPDX-License-Identifier: MIT
// What became of the chunks of a job: a file for each try to make one, in `attempts/`. Its name says how it went, so
// that one listing of the folder tells the state of all:
//
// A video that is joined is one more chunk behind the others.
//
//   CHUNK.TRY.begun    it began: where and when
//   CHUNK.TRY.exit-N   it ended with this exit code; the same, with what `run` reports
//
// A try that began and did not end was killed, or runs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "farm/job.h"

namespace afterglow::farm {

/// One file of `attempts/`, as far as its name tells.
struct AttemptFile {
  std::size_t chunk = 0;
  int number = 1;
  std::optional<int> exit_code;  ///< empty: it has not ended
  std::filesystem::path path;
};

/// By chunk and number. Errors: io.
Result<std::vector<AttemptFile>> attempts_of(const Job& job);

/// A try on this machine.
class Attempt {
 public:
  /// Takes the chunk's next number, whoever else does so at the same time. What earlier tries that were killed have
  /// left half-written goes. Errors: io.
  static Result<Attempt> begin(const Job& job, std::size_t chunk);
  /// `report` is what report_json made. A disk that is full takes the exit code all the same. Errors: io.
  Result<void> end(int exit_code, const std::string& error, const std::string& report) const;
  int number() const { return number_; }

 private:
  std::filesystem::path begun_;
  std::size_t chunk_ = 0;
  int number_ = 1;
};

/// This machine's name among those of the scheduler.
std::string node_name();

}  // namespace afterglow::farm
