// `afterglow run`: pictures in, finished pictures out.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "apps/command.h"
#include "apps/options.h"
#include "apps/output.h"
#include "batch/frame_list.h"
#include "batch/frame_loop.h"
#include "batch/lock.h"
#include "batch/resume.h"
#include "batch/run_report.h"
#include "batch/schedule.h"
#include "core/file.h"
#include "core/stopwatch.h"
#include "core/text.h"
#include "graph/history.h"
#include "image/input_space.h"
#include "image/reader.h"
#include "image/writer.h"

namespace afterglow {
namespace {

struct RunArguments {
  PresetArguments preset;
  DeviceArguments device;
  ExecutionArguments execution;
  FrameListRequest files;
  LayerArguments layers;
  std::string input_space, size, region;
  std::string type = "auto", dither = "auto", compression, nan_policy = "zero";
  int png_level = 1, jpeg_quality = 95;
  bool keep_layers = false, resume = false, fail_fast = false;
  double fps = 24;
  std::optional<int> pre_roll;
  std::string stats, report, lock, locked;
};

std::string space_list() {
  std::vector<std::string> names;
  for (const InputSpace& space : input_spaces()) names.emplace_back(space.name);
  return join(names);
}

void add_files(CLI::App& app, RunArguments& a) {
  app.add_option("INPUT", a.files.inputs, "Pictures: files, or sequences like shot.####.exr and shot.%04d.exr")
      ->required();
  app.add_option("-o,--output", a.files.output, "File, pattern (out.####.png) or folder; the extension says the format")
      ->type_name("OUTPUT")
      ->required();
  const std::string input = "Input", sequence = "Sequences", output = "Output";
  a.layers.add(app);
  app.add_option("--input-space", a.input_space,
                 "Colour space that pictures are stored in, whatever they say: " + space_list())
      ->type_name("NAME")
      ->group(input);
  app.add_option(
         "--size", a.size,
         "Scale the picture first, for a quick look: 640x360, 640 (the width), x360, 50%; lengths scale with it")
      ->type_name("SIZE")
      ->group(input);
  app.add_option(
         "--nan-policy", a.nan_policy,
         "For values that are not finite, in pictures or made by passes: zero (default), neighbour (the mean of "
         "finite neighbours) or fail (end with an error; every pass is looked at)")
      ->check(CLI::IsMember({"zero", "neighbour", "fail"}))
      ->type_name("POLICY")
      ->group(input);
  app.add_option("--region", a.region,
                 "Only this part of the picture, counted from the upper left corner: the crop of the whole result")
      ->type_name("X,Y,W,H")
      ->group(input);

  app.add_option("--frames", a.files.frames, "Frames to run: 1-24, 1-24x2, 1,5,10-12 (default: all there are)")
      ->type_name("LIST")
      ->group(sequence);
  app.add_option("--fps", a.fps, "Frames a second, for animated presets (default 24)")
      ->check(CLI::PositiveNumber)
      ->type_name("N")
      ->group(sequence);
  app.add_option(
         "--pre-roll", a.pre_roll,
         "Earlier frames to run first, without writing them, for effects that look back (default: what they ask "
         "for; 0: none)")
      ->check(CLI::Range(0, 100000))
      ->type_name("N")
      ->group(sequence);
  app.add_flag("--resume", a.resume, "Skip outputs that are newer than their inputs and made by the same look")
      ->group(sequence);
  app.add_flag("--fail-fast", a.fail_fast, "Stop at the first frame that fails")->group(sequence);

  app.add_option("--format", a.files.extension, "For outputs in a folder: png, exr, … (default: that of the input)")
      ->type_name("EXTENSION")
      ->group(output);
  app.add_option("--type", a.type,
                 "auto, half, float, uint8 or uint16 (auto: EXR half unless the input was float; else 8 bits, or 16 if "
                 "the input had more)")
      ->check(CLI::IsMember({"auto", "half", "float", "uint8", "uint16"}))
      ->type_name("TYPE")
      ->group(output);
  app.add_option("--compression", a.compression,
                 "EXR: none, rle, zip (default), zips, piz, pxr24, b44, b44a, dwaa, dwab; TIFF: its own")
      ->type_name("NAME[:LEVEL]")
      ->group(output);
  app.add_option("--png-level", a.png_level,
                 "PNG effort, 0 to 9 (default 1: six times faster than 6, files a little larger)")
      ->check(CLI::Range(0, 9))
      ->type_name("N")
      ->group(output);
  app.add_option("--jpeg-quality", a.jpeg_quality, "JPEG quality, 1 to 100 (default 95)")
      ->check(CLI::Range(1, 100))
      ->type_name("N")
      ->group(output);
  app.add_option(
         "--dither", a.dither,
         "auto, blue or none: blue noise between two codes, the same every time; none rounds to the nearest (auto: "
         "blue into 8 bits)")
      ->check(CLI::IsMember({"auto", "blue", "none"}))
      ->type_name("NOISE")
      ->group(output);
  app.add_flag("--keep-layers", a.keep_layers, "EXR to EXR: copy all other channels and parts unchanged")
      ->group(output);
}

void add_reports(CLI::App& app, RunArguments& a) {
  app.add_option("--lock", a.lock, "Write down what this was made with: hashes of scripts, shaders, options; versions")
      ->type_name("FILE.json")
      ->group("Output");
  app.add_option("--locked", a.locked, "Refuse to run when scripts, shaders or options are not those of this lock")
      ->type_name("FILE.json")
      ->excludes("--lock")
      ->group("Output");
  app.add_flag("--stats{total}", a.stats, "Print where the time went; --stats=passes adds each pass")
      ->check(CLI::IsMember({"total", "passes"}))
      ->type_name("[=passes]")
      ->group("Messages");
  app.add_option("--report", a.report, "Write times, skipped passes with reasons, and memory as JSON")
      ->type_name("FILE.json")
      ->group("Messages");
}

NanPolicy nan_policy(const std::string& text) {
  return text == "neighbour" ? NanPolicy::neighbour : text == "fail" ? NanPolicy::fail : NanPolicy::zero;
}

SampleType sample_type(const std::string& text) {
  if (text == "half") return SampleType::half;
  if (text == "float") return SampleType::float32;
  if (text == "uint8") return SampleType::uint8;
  if (text == "uint16") return SampleType::uint16;
  return SampleType::automatic;
}

constexpr int kFramesInFlight = 2;  // of a sequence: while one runs the next is packed and the last is unpacked

/// Every option that changes pixels, for --lock and the hash that --resume compares.
PixelOptions pixel_options(const RunArguments& a) {
  const auto flag = [](bool given) { return given ? "yes" : ""; };
  const auto number = [](std::optional<double> value) { return value ? fmt::format("{}", *value) : ""; };
  return {{"--set", join(a.preset.overrides, " ")},
          {"--at", a.preset.at},
          {"--arg", join(a.preset.values, " ")},
          {"--precision", a.execution.precision},
          {"--max-error", number(a.execution.max_error)},
          {"--reference", flag(a.execution.reference)},
          {"--layer", a.layers.layer},
          {"--input-space", a.input_space},
          {"--depth", a.layers.depth},
          {"--normal", a.layers.normal},
          {"--motion", a.layers.motion},
          {"--size", a.size},
          {"--region", a.region},
          {"--nan-policy", a.nan_policy == "neighbour" ? a.nan_policy : ""},
          {"--fps", number(a.fps)},
          {"--pre-roll", a.pre_roll ? fmt::format("{}", *a.pre_roll) : ""},
          {"--type", a.type},
          {"--compression", a.compression},
          {"--png-level", fmt::format("{}", a.png_level)},
          {"--jpeg-quality", fmt::format("{}", a.jpeg_quality)},
          {"--dither", a.dither},
          {"--keep-layers", flag(a.keep_layers)}};
}

std::string options_text(const PixelOptions& options) {
  std::string text;
  for (const auto& [name, value] : options) text += name + "=" + value + "|";
  return text;
}

/// Everything about one run that outlives a step.
struct Run {
  const RunArguments& arguments;
  Console& console;
  Clock::time_point start = Clock::now();
  std::unique_ptr<Session> session;
  FrameLoopOptions loop;
  RunReport report;
  std::optional<Lock> lock;  ///< of what runs, with --lock or --locked

  double milliseconds() const { return milliseconds_since(start); }
};

Result<SessionOptions> session_options(const RunArguments& a) {
  SessionOptions options;
  AFTERGLOW_TRY(options.device, a.device.options());
  AFTERGLOW_TRY(options.stack, a.execution.options());
  AFTERGLOW_TRY(options.stack.preset, a.preset.options());
  options.stack.flag_non_finite = true;
  if (a.stats == "passes") options.timing = KernelTiming::timestamps;
  return options;
}

WriteOptions write_options(const RunArguments& a) {
  WriteOptions options;
  options.type = sample_type(a.type);
  options.compression = a.compression;
  options.png_level = a.png_level;
  options.jpeg_quality = a.jpeg_quality;
  if (a.dither != "auto") options.dither = a.dither == "blue";
  options.keep_layers = a.keep_layers;
  return options;
}

FrameListRequest files_of(const RunArguments& a) {
  FrameListRequest request = a.files;
  a.layers.choose(request);
  return request;
}

/// How many earlier frames the frames of this run need; empty when none depends on another. Where settings change from
/// frame to frame some frames are asked.
Result<std::optional<int>> pre_roll_of(Run& run, FrameLoop& loop) {
  constexpr std::size_t kMostAsked = 64;
  const auto& frames = run.report.frames;
  Preset& preset = run.session->preset();
  const std::size_t asked = preset.may_change() ? std::min(frames.size(), kMostAsked) : 1;
  std::optional<int> most;
  for (std::size_t i = 0; i < asked; ++i) {
    AssumedPicture assumed;
    assumed.frame = frames[i * frames.size() / asked].job.frame;
    assumed.fps = run.arguments.fps;
    AFTERGLOW_TRY(const BuildContext context, assumed.context(preset));
    // A picture alone is asked itself, and what is said of it is what runs.
    auto build = frames.size() == 1 ? loop.inspect(frames.front().job) : run.session->evaluate(context);
    if (!build && frames.size() == 1 && build.error().kind == ErrorKind::io) build = run.session->evaluate(context);
    if (!build) return std::move(build).error();
    const Graph& graph = (*build)->graph;
    if (!graph.histories.empty()) most = std::max(most.value_or(0), run.arguments.pre_roll.value_or(pre_roll(graph)));
  }
  return most;
}

/// The graph of frames as they usually are.
Result<Graph> usual_graph(Run& run) {
  AssumedPicture assumed;
  AFTERGLOW_TRY(const BuildContext context, assumed.context(run.session->preset()));
  AFTERGLOW_TRY(const auto build, run.session->evaluate(context));
  return build->graph;
}

/// Hash of the look for --resume, and the frames that need not be made.
Result<void> prepare_resume(Run& run) {
  const RunArguments& a = run.arguments;
  if (!a.resume && run.report.frames.size() < 2) return {};
  AFTERGLOW_TRY(const Graph graph, usual_graph(run));
  const std::string options = options_text(pixel_options(a)) + execution_name(run.session->stack().choice().execution);
  AFTERGLOW_TRY(const Hash look, look_hash(run.session->preset(), graph, options));
  run.loop.record_look = look;
  if (!a.resume) return {};
  if (const int left = remove_leftovers(run.report.frames))
    run.console.note(fmt::format("removed {} half-written files of runs that were killed", left));
  for (auto& frame : run.report.frames)
    if (is_up_to_date(frame.job, look)) {
      frame.state = FrameRecord::State::up_to_date;
      run.console.note(fmt::format("{} is up to date", frame.job.output.string()));
    }
  return {};
}

/// With --locked, ends the run when the look is another; with --lock, what to write when the run is done.
Result<void> prepare_lock(Run& run) {
  const RunArguments& a = run.arguments;
  if (a.lock.empty() && a.locked.empty()) return {};
  AFTERGLOW_TRY(const Graph graph, usual_graph(run));
  AFTERGLOW_TRY(run.lock, lock_of(*run.session, graph, pixel_options(a)));
  if (a.locked.empty()) return {};
  AFTERGLOW_TRY(const Lock locked, read_lock(a.locked));
  return hold_against(locked, *run.lock, a.locked, run.console.diagnostics());
}

/// Outputs that cannot be written are refused before any work: one of each folder and format.
Result<void> check_outputs(const Run& run) {
  std::set<std::pair<std::filesystem::path, std::filesystem::path>> seen;
  for (const auto& frame : run.report.frames) {
    const auto& output = frame.job.output;
    if (!seen.emplace(output.parent_path(), output.extension()).second) continue;
    AFTERGLOW_CHECK(check_output(output, run.loop.write));
  }
  return {};
}

RunEvents events_of(Console& console) {
  return {.diagnostics = console.diagnostics(),
          .progress = [&console](std::size_t done, std::size_t total, const std::string& label,
                                 double seconds) { console.progress(done, total, label, seconds); },
          .end_progress = [&console] { console.end_progress(); },
          .failed = [&console](const Error& error) { console.error(error); },
          .interrupted = interrupted};
}

Result<void> run_frames(Run& run, const SessionOptions& options) {
  const RunArguments& a = run.arguments;
  run.loop.write = write_options(a);
  run.loop.nan_policy = nan_policy(a.nan_policy);
  run.loop.fail_fast = a.fail_fast || run.loop.nan_policy == NanPolicy::fail;
  run.loop.fps = a.fps;
  run.loop.max_memory = options.stack.max_memory;
  run.loop.read.layer = a.layers.layer;
  run.loop.read.max_bytes = options.stack.max_memory;
  if (!a.size.empty()) {
    AFTERGLOW_TRY(run.loop.size, parse_size_wish(a.size));
    if (a.keep_layers)
      return Error{ErrorKind::usage, "--keep-layers copies layers as they are and cannot go with --size",
                   "afterglow run"};
  }
  if (!a.region.empty()) {
    AFTERGLOW_TRY(run.loop.region, parse_region(a.region));
    run.loop.write.dither_x = run.loop.region->x;
    run.loop.write.dither_y = run.loop.region->y;
    if (a.keep_layers)
      return Error{ErrorKind::usage, "--keep-layers copies layers as they are and cannot go with --region",
                   "afterglow run"};
  }
  run.loop.reuse = !a.execution.reference;
  AFTERGLOW_CHECK(check_outputs(run));
  AFTERGLOW_TRY(const std::filesystem::path preset, a.preset.preset_file());
  SessionOptions opened = options;
  opened.frames = run.report.frames.size() > 1 ? kFramesInFlight : 1;
  AFTERGLOW_TRY(run.session, Session::open(preset, opened, run.console.diagnostics()));
  run.loop.read.auxiliary = run.session->preset().needs();
  run.loop.read.input_space = a.input_space.empty() ? run.session->preset().input_space() : a.input_space;
  AFTERGLOW_CHECK(prepare_lock(run));
  FrameLoop loop(*run.session, run.loop, events_of(run.console));
  AFTERGLOW_TRY(const std::optional<int> earlier, pre_roll_of(run, loop));
  if (earlier) loop.follow_histories();
  if (earlier && a.resume) note_earlier_files(run.report.frames, files_of(a), *earlier);
  AFTERGLOW_CHECK(prepare_resume(run));
  Schedule schedule =
      earlier ? schedule_with_histories(run.report.frames, files_of(a), *earlier) : plain_schedule(run.report.frames);
  run.report.pre_roll = schedule.earlier.size();
  run.report.startup = std::max(0.0, run.milliseconds() - run.session->report().times.script);
  loop.record_look(run.loop.record_look);
  auto done = loop.run(schedule);
  run.report.memory_needed = loop.largest_need();
  return done;
}

Result<void> run_run(const RunArguments& a, Console& console) {
  Run run{a, console};
  AFTERGLOW_TRY(const SessionOptions options, session_options(a));
  AFTERGLOW_TRY(const auto jobs, list_frames(files_of(a)));
  for (const auto& job : jobs) run.report.frames.push_back({.job = job});
  auto done = run_frames(run, options);
  if (done && !a.lock.empty()) done = write_file_atomically(a.lock, lock_text(*run.lock));
  if (run.session) run.report.session = run.session->report();
  run.report.wall = run.milliseconds();
  if (!a.stats.empty() && run.session) output("{}", report_text(run.report, a.stats == "passes"));
  if (!a.report.empty()) {
    auto written = write_file_atomically(a.report, report_json(run.report));
    if (done && !written) return written;
  }
  return done;
}

}  // namespace

Command add_run_command(CLI::App& program) {
  auto* app = program.add_subcommand("run", "Apply a preset to pictures");
  auto arguments = std::make_shared<RunArguments>();
  arguments->preset.add(*app);
  add_files(*app, *arguments);
  arguments->device.add(*app);
  arguments->execution.add(*app);
  add_reports(*app, *arguments);
  app->footer(
      "Examples:\n"
      "  afterglow run presets/neon_night.lua render.exr -o render.png\n"
      "  afterglow run look.lua shot.####.exr -o graded/shot.####.exr --frames 1-240 --resume\n"
      "  afterglow run look.lua *.exr -o graded/ --format png --set glow.strength=0.4 --stats\n"
      "Outputs appear whole or not at all. Notes for --resume lie in the output's folder, in .afterglow/.");
  return {app, [arguments](Console& console) { return run_run(*arguments, console); }};
}

}  // namespace afterglow
