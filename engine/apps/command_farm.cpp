// SPDX-License-Identifier: MIT
// `afterglow farm`: thousands of frames over a cluster.
#include <fmt/format.h>

#include <memory>

#include "apps/command.h"
#include "apps/farm_arguments.h"
#include "apps/farm_chunk.h"
#include "apps/farm_submit.h"
#include "apps/farm_wait.h"
#include "apps/output.h"
#include "core/file.h"
#include "core/text.h"
#include "core/written_files.h"
#include "farm/slurm.h"
#include "farm/status.h"

namespace afterglow {
namespace {

Result<void> report_on(const farm::Job& job, const FarmArguments& a) {
  AFTERGLOW_TRY(const auto status, farm::status_of(job));
  AFTERGLOW_TRY(const auto report, farm::merged_report(job, status));
  if (!a.run.report.empty()) return output_file(a.run.report, report.json);
  output("{}", report.text);
  return {};
}

Result<void> check_submitted(const farm::Job& job, const char* what) {
  AFTERGLOW_TRY(const auto submissions, farm::read_submissions(job));
  return farm::check_submitted(job, submissions, what);
}

/// What follows a submission.
Result<void> go_on(const farm::Job& job, const FarmArguments& a, Console& console) {
  if (!a.wait) return {};
  AFTERGLOW_CHECK(check_submitted(job, "wait for it"));
  const auto done = wait_for_job(job, console);
  if (!a.run.report.empty() && (done || done.error().kind != ErrorKind::interrupted))
    AFTERGLOW_CHECK(report_on(job, a));
  return done;
}

void tell_submission(const farm::Job& job, const farm::Submissions& submitted, const std::vector<std::size_t>& tasks) {
  std::vector<std::string> ids;
  for (const auto& array : submitted.arrays) ids.push_back(array.id);
  const bool joins = job.is_join(tasks.back());
  output("{}\nslurm {}: {} chunks{}\n", job.folder.string(), join(ids), tasks.size() - (joins ? 1 : 0),
         joins ? " and the join" : "");
}

Result<void> run_submit(const FarmArguments& a, Console& console) {
  AFTERGLOW_TRY(PlannedJob planned, plan_job(a, !a.dry_run, console));
  const farm::Job& job = planned.job;
  if (a.dry_run) {
    output("{}", farm::plan_text(job));
    return {};
  }
  if (!a.jobs.empty()) {
    const auto text = farm::jobs_text(job, planned.files, planned.frames);
    const auto written = text ? output_file(a.jobs, *text) : text.error();
    if (!written) {
      discard(planned);
      return written;
    }
    output("{}\n{}: {} chunks\n", job.folder.string(), a.jobs, job.chunks.size());
    return {};
  }
  auto submitted = farm::submit(job, farm::every_task(job));
  planned.alone.reset();
  if (!submitted) {
    if (!is_file(job.folder / "slurm.json")) discard(planned);
    return std::move(submitted).error();
  }
  tell_submission(job, *submitted, farm::every_task(job));
  return go_on(job, a, console);
}

Result<void> run_retry(farm::Job job, const FarmArguments& a, Console& console) {
  AFTERGLOW_CHECK(check_submitted(job, "start what is missing"));
  AFTERGLOW_TRY(const auto status, farm::status_of(job));
  const auto tasks = farm::tasks_to_retry(job, status);
  if (!tasks.empty()) {
    AFTERGLOW_CHECK(farm::check_packed(job));
    for (const auto& [given, kept] :
         {std::pair(&a.needs.partition, &job.needs.partition), std::pair(&a.needs.time, &job.needs.time),
          std::pair(&a.needs.memory, &job.needs.memory)})
      if (!given->empty()) *kept = *given;
    if (!a.needs.more.empty()) job.needs.more = a.needs.more;
    if (a.gives("--retries")) {
      job.needs.retries = a.needs.retries;
      AFTERGLOW_CHECK(farm::write_task_script(job));
    }
    AFTERGLOW_TRY(const auto submitted, farm::submit(job, tasks));
    tell_submission(job, submitted, tasks);
  } else {
    output("nothing to retry: {}\n", farm::status_line(status));
  }
  return go_on(job, a, console);
}

Result<void> run_farm(const FarmArguments& a, Console& console) {
  AFTERGLOW_CHECK(a.check_word());
  keep_standard_output_for({a.run.report, a.jobs});
  const std::string word = a.word();
  const auto& given = a.run.files.inputs;
  if (word.empty()) return run_submit(a, console);
  if (word == "chunk") {
    if (given.size() == 2) return run_chunk(given[0], given[1], console);
    return Error{ErrorKind::usage, "chunk needs a job's folder and a number", "afterglow farm"};
  }
  const SideFile report{"--report", a.run.report};
  AFTERGLOW_CHECK(check_written({&report, 1}, {}, {}));
  AFTERGLOW_TRY(farm::Job job, farm::find_job(given.empty() ? "." : given.front()));
  if (word == "join") return run_join(job, console);
  if (word == "report") return report_on(job, a);
  if (word == "retry") return run_retry(std::move(job), a, console);
  if (word == "cancel") return farm::cancel(job);
  AFTERGLOW_TRY(const auto status, farm::status_of(job));
  output("{}", farm::status_text(job, status, a.all));
  return go_on(job, a, console);
}

}  // namespace

Command add_farm_command(CLI::App& program) {
  auto* app = program.add_subcommand("farm", "Apply a preset to sequences on the machines of a Slurm cluster");
  auto arguments = std::make_shared<FarmArguments>();
  arguments->add(*app);
  app->footer(
      "Examples:\n"
      "  afterglow farm look.lua shot.####.exr -o graded/ --chunk 20 --wait\n"
      "  afterglow farm look.lua shot.####.exr -o graded/ --partition night --mem 8G -- --exclude=n13 --nice\n"
      "  afterglow farm look.lua clip.mov -o graded.mov --codec prores --wait\n"
      "  afterglow farm status graded/         where the job is; also report, cancel and retry\n"
      "  afterglow farm look.lua shot.####.exr -o graded/ --jobs jobs.json\n"
      "Words behind -- go to sbatch. The look is packed when it is submitted; what is edited later changes nothing.");
  return {app, [arguments](Console& console) { return run_farm(*arguments, console); }, &arguments->needs.more};
}

}  // namespace afterglow
