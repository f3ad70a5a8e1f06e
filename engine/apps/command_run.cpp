// SPDX-License-Identifier: MIT
// `afterglow run`: pictures in, finished pictures out.
#include <memory>

#include "apps/command.h"
#include "apps/output.h"
#include "apps/run_arguments.h"
#include "apps/run_events.h"
#include "apps/sandbox.h"
#include "batch/run_report.h"

namespace afterglow {
namespace {

Result<void> run_run(const RunArguments& a, Console& console) {
  keep_standard_output_for({a.report, a.files.output});
  AFTERGLOW_TRY(const BatchRequest request, a.request());
  a.preset.tell_of_namesake(request.preset, console.diagnostics());
  if (a.sandbox) {
    AFTERGLOW_CHECK(make_folder(new_folder(a.files.output)));  // what it lies in is out of reach afterwards
    AFTERGLOW_TRY(const Confinement left, sandbox_of(a));
    AFTERGLOW_CHECK(confine(left));
  }
  constexpr unsigned kSecondsToEndAVideo = 60;
  if (a.keep_partial) allow_to_end(kSecondsToEndAVideo);
  RunReport report;
  auto done = run_batch(request, run_events(console), report);
  if (!a.stats.empty() && report.session) output("{}", report_text(report, a.stats == "passes"));
  if (!a.report.empty() && report.replaces_nothing) {
    auto written = output_file(a.report, report_json(report));
    if (done && !written) return written;
  }
  return done;
}

}  // namespace

Command add_run_command(CLI::App& program) {
  auto* app = program.add_subcommand("run", "Apply a preset to pictures");
  auto arguments = std::make_shared<RunArguments>();
  arguments->add(*app);
  app->footer(
      "Examples:\n"
      "  afterglow run presets/neon_night.lua render.exr -o render.png\n"
      "  afterglow run look.lua shot.####.exr -o graded/ --frames 1-240 --resume\n"
      "  afterglow run look.lua *.exr -o graded/ --format png --set bloom.intensity=0.4 --stats\n"
      "  afterglow run look.lua clip.mov -o graded.mp4 --crf 16\n"
      "  ffmpeg -i clip.mp4 -f yuv4mpegpipe - | afterglow run look.lua - -o - | ffmpeg -i - graded.mp4\n"
      "Outputs appear whole or not at all. Notes for --resume lie in the output's folder, in .afterglow/.");
  return {app, [arguments](Console& console) { return run_run(*arguments, console); }};
}

}  // namespace afterglow
