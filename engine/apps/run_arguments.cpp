// SPDX-License-Identifier: MIT
#include "apps/run_arguments.h"

#include <fmt/format.h>

#include "core/text.h"

namespace afterglow {
namespace {

void add_files(CLI::App& app, RunArguments& a) {
  app.add_option("INPUT", a.files.inputs,
                 "Pictures: files, sequences like shot.####.exr and shot.%04d.exr, folders that hold one, videos; - is "
                 "standard input")
      ->required();
  app.add_option("-o,--output", a.files.output,
                 "File, pattern (out.####.png), folder (NAME/ is made if need be), video (mp4, mov, mkv, webm, gif, "
                 "apng) or - (standard output); the extension says the format")
      ->type_name("OUTPUT")
      ->required();
  const std::string input = "Input", sequence = "Sequences", output = "Output";
  a.layers.add(app);
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
  app.add_flag("--sandbox", a.sandbox,
               "For pictures from strangers: the process gives up the network, other programs and every file but the "
               "pictures, the look's and the output's folder (Linux: Landlock, seccomp)")
      ->group(input);
  app.add_option("--region", a.region,
                 "Only this part of the picture, counted from the upper left corner: the crop of the whole result")
      ->type_name("X,Y,W,H")
      ->group(input);

  app.add_option("--raw", a.files.raw,
                 "How raw frames on standard input (-) lie: 1920x1080:rgb48le[:24], pixels by FFmpeg's names")
      ->type_name("WxH:PIXELS[:FPS]")
      ->group(input);
  app.add_option("--frames", a.files.frames, "Frames to run: 1-24, 1-24x2, 1,5,10-12 (default: all there are)")
      ->type_name("LIST")
      ->group(sequence);
  app.add_option(
         "--fps", a.fps,
         "Frames a second, for animated presets, and of videos that are made of pictures (default: for videos what the "
         "first picture says, else 24)")
      ->transform(frame_rates())
      ->type_name("N")
      ->group(sequence);
  app.add_option(
         "--pre-roll", a.pre_roll,
         "Earlier frames to run first, without writing them, for effects that look back (default: what they ask "
         "for; 0: none)")
      ->check(CLI::Range(0, 100000))
      ->type_name("N")
      ->group(sequence);
  add_cuts(app, a.cuts, sequence);
  app.add_flag("--resume", a.resume,
               "Skip outputs that are as they were left, and made by the same look of the same inputs")
      ->group(sequence);
  app.add_flag("--watch", a.watch,
               "Inputs may still be written: run frames as they appear whole, again when they change, until all of "
               "--frames are done")
      ->group(sequence);
  app.add_flag("--fail-fast", a.fail_fast, "Stop at the first frame that fails")->group(sequence);

  app.add_option("--format", a.files.extension,
                 "For outputs in a folder: png, exr, … (default: that of the input); for -o -: y4m (default), raw, "
                 "ppm, pam, pfm, png, or one picture of any format")
      ->type_name("EXTENSION")
      ->group(output);
  app.add_option(
         "--type", a.type,
         "auto, half, float, uint8, uint10, uint12 or uint16 (auto: EXR half unless the input was float; DPX and "
         "Cineon 10 bits; else 8 bits, or 16 if the input had more)")
      ->check(CLI::IsMember({"auto", "half", "float", "uint8", "uint10", "uint12", "uint16"}))
      ->type_name("TYPE")
      ->group(output);
  app.add_option("--output-space", a.output_space,
                 "Colour space of integer samples: a name of --input-space (default: cineon for DPX and Cineon, srgb "
                 "for other pictures); of EXR a linear one: acescg, aces2065_1, lin_p3d65, lin_rec2020, linear")
      ->type_name("SPACE")
      ->group(output);
  app.add_option("--compression", a.compression,
                 "EXR: none, rle, zip (default), zips, piz, pxr24, b44, b44a, dwaa, dwab; TIFF: none, lzw, zip, "
                 "packbits; WebP: lossless, lossy:QUALITY; Targa: none, rle")
      ->type_name("COMPRESSION[:LEVEL]")
      ->group(output);
  app.add_option("--png-level", a.png_level,
                 "PNG effort, 0 to 9 (default 1: five times faster than 6, files up to a tenth larger)")
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
  const std::string video = "Video";
  app.add_option("--codec", a.codec,
                 "mp4: h264 (default), h265, av1, vp9; mov: prores (default; prores4444 for alpha), prores4444, dnxhr, "
                 "h264, h265; mkv: h264 (default), h265, ffv1, prores, prores4444, vp9, av1; webm: vp9 (default), av1")
      ->type_name("CODEC")
      ->group(video);
  app.add_option("--crf", a.crf,
                 "Quality, 0 is best (default: h264 18, h265 20, vp9 24, av1 26); prores, dnxhr and ffv1 take none")
      ->type_name("N")
      ->group(video);
  app.add_option("--bitrate", a.bitrate, "In place of a quality: 8M, 500k bits a second")
      ->excludes("--crf")
      ->type_name("RATE")
      ->group(video);
  app.add_option(
         "--pix-fmt", a.pixel_format,
         "Pixel format by FFmpeg's name: yuv420p, yuv422p10, yuva444p10, gbrp16, rgb48le, … (default: what suits "
         "the codec and the pictures' depth)")
      ->type_name("NAME")
      ->group(video);
  app.add_option(
         "--audio", a.audio,
         "Sound from this file (default: that of a video input), encoded only where the container does not take it; "
         "copy: only what it takes; none: no sound")
      ->type_name("FILE")
      ->group(video);
  app.add_flag("--keep-partial", a.keep_partial, "An interrupted video is ended as a shorter one that is whole")
      ->group(video);
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
  app.add_option("--report", a.report,
                 "Write times, skipped passes with reasons, and memory as JSON (-: standard output)")
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
  if (text == "uint10") return SampleType::uint10;
  if (text == "uint12") return SampleType::uint12;
  if (text == "uint16") return SampleType::uint16;
  return SampleType::automatic;
}

/// Every option that changes pixels, for --lock and the hash that --resume compares.
PixelOptions pixel_options(const RunArguments& a) {
  const auto flag = [](bool given) { return given ? "yes" : ""; };
  const auto number = [](std::optional<double> value) { return value ? fmt::format("{}", *value) : ""; };
  const auto other = [](const std::string& word, const char* usual) { return word == usual ? "" : word; };
  return {{"--set", join(a.preset.overrides, " ")},
          {"--at", a.preset.at},
          {"--arg", join(a.preset.values, " ")},
          {"--precision", a.execution.precision},
          {"--max-error", number(a.execution.max_error)},
          {"--reference", flag(a.execution.reference)},
          {"--layer", a.layers.layer},
          {"--input-space", a.layers.input_space},
          {"--gamut", a.layers.gamut},
          {"--overscan", other(a.layers.overscan, "keep")},
          {"--depth", a.layers.depth},
          {"--normal", a.layers.normal},
          {"--motion", a.layers.motion},
          {"--mattes", a.layers.mattes},
          {"--size", a.size},
          {"--region", a.region},
          {"--nan-policy", a.nan_policy == "neighbour" ? a.nan_policy : ""},
          {"--fps", number(a.fps.value_or(FrameLoopOptions{}.fps))},
          {"--pre-roll", a.pre_roll ? fmt::format("{}", *a.pre_roll) : ""},
          {"--cuts", a.cuts},
          {"--type", a.type},
          {"--output-space", a.output_space},
          {"--codec", a.codec},
          {"--crf", a.crf ? fmt::format("{}", *a.crf) : ""},
          {"--bitrate", a.bitrate},
          {"--pix-fmt", a.pixel_format},
          {"--audio", a.audio},
          {"--compression", a.compression},
          {"--png-level", fmt::format("{}", a.png_level.value_or(1))},
          {"--jpeg-quality", fmt::format("{}", a.jpeg_quality.value_or(95))},
          {"--dither", a.dither},
          {"--keep-layers", flag(a.keep_layers)}};
}

Result<SessionOptions> session_options(const RunArguments& a) {
  SessionOptions options;
  AFTERGLOW_TRY(options.device, a.device.options());
  AFTERGLOW_TRY(options.stack, a.execution.options());
  AFTERGLOW_TRY(options.stack.preset, a.preset.options());
  options.stack.flag_non_finite = true;
  if (a.stats == "passes") options.timing = KernelTiming::timestamps;
  return options;
}

Result<WriteOptions> write_options(const RunArguments& a) {
  WriteOptions options;
  AFTERGLOW_TRY(options.space, find_output_space(a.output_space));
  options.type = sample_type(a.type);
  options.compression = a.compression;
  options.video = {a.codec, a.pixel_format, a.bitrate, a.crf, a.audio};
  options.png_level = a.png_level;
  options.jpeg_quality = a.jpeg_quality;
  if (a.dither != "auto") options.dither = a.dither == "blue";
  options.keep_layers = a.keep_layers;
  return options;
}

/// What the options say of the frames themselves.
Result<FrameLoopOptions> loop_options(const RunArguments& a, std::uint64_t max_memory) {
  FrameLoopOptions options;
  AFTERGLOW_TRY(options.write, write_options(a));
  options.nan_policy = nan_policy(a.nan_policy);
  options.keep_partial = a.keep_partial;
  options.fail_fast = a.fail_fast || options.nan_policy == NanPolicy::fail;
  options.fps = a.fps.value_or(options.fps);
  options.takes_fps = !a.fps;
  if (!a.cuts.empty()) {
    AFTERGLOW_TRY(options.cuts, parse_cuts(a.cuts));
  }
  options.max_memory = max_memory;
  a.layers.choose_reading(options.read);
  options.read.max_bytes = max_memory;
  options.reuse = !a.execution.reference;
  const auto not_with = [](const char* option) {
    return Error{ErrorKind::usage,
                 fmt::format("--keep-layers copies layers as they are and cannot go with {}", option)};
  };
  if (!a.size.empty()) {
    AFTERGLOW_TRY(options.size, parse_size_wish(a.size));
    if (a.keep_layers) return not_with("--size");
  }
  if (!a.region.empty()) {
    AFTERGLOW_TRY(options.region, parse_region(a.region));
    options.write.dither_x = options.region->x;
    options.write.dither_y = options.region->y;
    if (a.keep_layers) return not_with("--region");
  }
  return options;
}

}  // namespace

void RunArguments::add(CLI::App& command) {
  preset.add(command);
  add_files(command, *this);
  device.add(command);
  execution.add(command);
  add_reports(command, *this);
}

Result<BatchRequest> RunArguments::request() const {
  BatchRequest out{.files = files,
                   .input_space = layers.input_space,
                   .pre_roll = pre_roll,
                   .resume = resume,
                   .pixel_options = pixel_options(*this),
                   .lock = lock,
                   .locked = locked,
                   .beside = {{"--lock", lock}, {"--report", report}}};
  if (watch && files.frames.empty())
    return Error{ErrorKind::usage, "--watch needs --frames: it ends when they are done"};
  if (lock == "-") return Error{ErrorKind::usage, "--lock is a file, to be read by --locked; '-' is none"};
  if (report == "-" && files.output == "-")
    return Error{ErrorKind::usage, "--report - and -o - are both standard output"};
  out.watch = watch;
  layers.choose(out.files);
  out.files.mattes.file = layers.mattes;
  AFTERGLOW_TRY(out.session, session_options(*this));
  AFTERGLOW_TRY(out.loop, loop_options(*this, out.session.stack.max_memory));
  AFTERGLOW_TRY(out.preset, preset.preset_file());
  out.files.limits = {out.loop.read.max_side, out.loop.read.max_bytes};
  return out;
}

}  // namespace afterglow
