// SPDX-License-Identifier: MIT
// Every JSON file that the program reads: calibrations, locks, goals, earlier reports of bench, farm jobs and what
// their chunks leave.
#include <cmath>

#include "batch/lock.h"
#include "bench/goals.h"
#include "bench/report.h"
#include "exec/calibration.h"
#include "farm/slurm.h"
#include "farm/status.h"
#include "fuzz.h"

using namespace afterglow;

namespace {

template <class T>
void check(const Result<T>& read) {
  if (!read) fuzz::check_error(read.error(), {ErrorKind::io, ErrorKind::usage});
}

/// A job with this description, submissions or report of a chunk.
void check_farm(const std::string& text) {
  fuzz::write("job.json", text);
  if (auto job = farm::read_job(fuzz::scratch())) {
    FUZZ_CLAIM(farm::write_job(*job).ok(), text);
    const auto again = farm::read_job(fuzz::scratch());
    FUZZ_CLAIM(again.ok() && again->run == job->run && again->chunks.size() == job->chunks.size(), text);
  } else {
    check(job);
  }
  farm::Job job;
  job.folder = fuzz::scratch();
  job.chunks = {{{"a.####.exr"}, "1-2", 2}};
  fuzz::write("slurm.json", text);
  check(farm::read_submissions(job));
  std::filesystem::remove(fuzz::scratch() / "slurm.json");
  std::filesystem::create_directory(fuzz::scratch() / "attempts");
  fuzz::write("attempts/0.1.exit-4", text);
  const auto status = farm::status_of(job);
  FUZZ_CLAIM(status.ok() && farm::merged_report(job, *status).ok(), text);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(fuzz::text_of(data, size));
  const auto file = fuzz::write("file.json", text);
  if (const auto table = Calibration::parse(text, file.string()); !table) {
    check(table);
  } else {
    for (const auto& entry : table->entries)
      for (const auto& choice : entry.choices) FUZZ_CLAIM(choice.max_error >= 0, entry.name());
    (void)table->find({.name = "llvmpipe", .type = "cpu", .driver = "Mesa"}, 2e-3);
  }
  if (const auto lock = read_lock(file)) {
    Diagnostics silent;
    const auto held = hold_against(*lock, {}, file, silent);
    if (!held) fuzz::check_error(held.error(), {ErrorKind::script});
    fuzz::write("again.json", lock_text(*lock));
    const auto again = read_lock(fuzz::scratch() / "again.json");
    FUZZ_CLAIM(again.ok() && again->files == lock->files && again->options == lock->options, text);
  } else {
    check(lock);
  }
  check_farm(text);
  check(bench::load_goals(file));
  check(bench::compare_reports(text, file.string(), {}));
  return 0;
}
