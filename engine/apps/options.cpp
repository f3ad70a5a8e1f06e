// SPDX-License-Identifier: MIT
#include "apps/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "core/memory_limit.h"
#include "core/parse_number.h"
#include "core/paths.h"
#include "core/text.h"
#include "exec/calibration.h"
#include "image/input_space.h"
#include "image/video_writer.h"

namespace afterglow {

void MessageArguments::add(CLI::App& command) {
  command.add_flag("-v,--verbose", verbose, "Show notes too, not only warnings")->group("Messages");
  command.add_flag("-q,--quiet", quiet, "Show errors alone; no progress bar")->group("Messages");
  command.add_flag("--no-color", no_color, "No colours, even on a terminal")->group("Messages");
}

void MessageArguments::apply(Console& console) const {
  console.configure(quiet ? Verbosity::quiet : verbose ? Verbosity::verbose : Verbosity::normal, !no_color);
}

CLI::Validator above_zero() {
  const auto fault = [](const std::string& text) {
    const auto number = parse_number<double>(text);
    return number && *number > 0 ? std::string() : fmt::format("{} is no number above 0", text);
  };
  return {fault, "POSITIVE"};
}

CLI::Validator frame_numbers() {
  const auto fault = [](const std::string& text) {
    const auto number = parse_number<double>(text);
    return number && std::isfinite(*number) ? std::string() : fmt::format("{} is no number of a frame", text);
  };
  return {fault, "N"};
}

/// "23.976" or, as videos have it, "24000/1001".
std::optional<double> parse_rate(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return parse_number<double>(text);
  const auto frames = parse_number<double>(text.substr(0, slash)),
             seconds = parse_number<double>(text.substr(slash + 1));
  return frames && seconds && *seconds > 0 ? std::optional(*frames / *seconds) : std::nullopt;
}

CLI::Validator frame_rates() {
  const auto take = [](std::string& text) {
    const auto number = parse_rate(text);
    if (!number || !(*number >= kSlowestRate && *number <= kFastestRate))
      return fmt::format("{} is no number of frames a second, {} to {}", text, kSlowestRate, kFastestRate);
    text = fmt::format("{}", *number);
    return std::string();
  };
  return {take, "FPS"};
}

void add_cuts(CLI::App& command, std::string& into, const std::string& group) {
  command
      .add_option("--cuts", into,
                  "Frames that begin a shot, where effects that look back begin anew: 25,49; auto: found in the "
                  "pictures; all: each by itself; none (default: found in videos, none in pictures)")
      ->type_name("LIST")
      ->group(group);
}

CLI::Option* add_repeatable(CLI::App& command, const std::string& name, std::vector<std::string>& into,
                            const std::string& help, const char* type) {
  return command.add_option(name, into, help)->type_name(type)->expected(1)->allow_extra_args(false)->take_all();
}

void PresetArguments::add(CLI::App& command) {
  command
      .add_option("PRESET", file, "Look to apply: a Lua file that returns a stack, its name, or a pack that holds it")
      ->required();
  add_overrides(command);
  command
      .add_option("--at", at, "Where the picture is seen from, for volumes (default: the preset's, else the file's)")
      ->type_name("X,Y,Z")
      ->group("Preset");
  add_repeatable(command, "--arg", values,
                 "Value of an argument that the preset declares by fx.args: strength=0.3 (repeatable)", "NAME=VALUE")
      ->group("Preset");
  add_paths(command);
}

void PresetArguments::add_overrides(CLI::App& command) {
  add_repeatable(command, "--set", overrides,
                 "Overrides one setting, as if the preset said so: bloom.intensity=0.4 (repeatable)",
                 "EFFECT.SETTING=VALUE")
      ->group("Preset");
}

void PresetArguments::add_paths(CLI::App& command) {
  add_repeatable(command, "--path", paths,
                 "Folder or zip with presets/, effects/ and shaders/ of yours, before AFTERGLOW_PATH and the "
                 "installation (repeatable)",
                 "FOLDER")
      ->group("Preset");
}

void LayerArguments::add(CLI::App& command) {
  const std::string group = "Input";
  command
      .add_option("--layer", layer, "Colour layer or part (default: the usual names, Combined and plain R,G,B first)")
      ->type_name("NAME")
      ->group(group);
  command
      .add_option(
          "--input-space", input_space,
          "Colour space that pictures are stored in, whatever they and the look say: " + join(input_space_names()))
      ->type_name("SPACE")
      ->group(group);
  command
      .add_option(
          "--gamut", gamut,
          "What becomes of components below 0, which colours outside of Rec.709 have: cut (they end at 0) or keep "
          "(default: as the look says, else cut)")
      ->check(CLI::IsMember({"cut", "keep"}))
      ->type_name("WORD")
      ->group(group);
  command
      .add_option("--overscan", overscan,
                  "What lies outside of an EXR's display window: keep (default; part of the picture) or cut")
      ->check(CLI::IsMember({"keep", "cut"}))
      ->type_name("WORD")
      ->group(group);
  command.add_option("--depth", depth, "Depth from another file or channel; FILE may be a pattern")
      ->type_name("FILE[:CHANNEL]")
      ->group(group);
  command.add_option("--normal", normal, "Normals from another file or layer; FILE may be a pattern")
      ->type_name("FILE[:LAYER]")
      ->group(group);
  command.add_option("--motion", motion, "Motion vectors from another file or layer; FILE may be a pattern")
      ->type_name("FILE[:LAYER]")
      ->group(group);
  command
      .add_option("--mattes", mattes,
                  "Layers and cryptomattes that the picture has not, from another file; may be a pattern")
      ->type_name("FILE")
      ->group(group);
}

void LayerArguments::choose_reading(ReadOptions& options) const {
  options.layer = layer;
  if (!gamut.empty()) options.keep_negative = gamut == "keep";
  options.cut_overscan = overscan == "cut";
}

Result<void> PresetArguments::check_paths() const {
  for (const auto& path : paths) {
    std::error_code ec;
    if (!std::filesystem::exists(path, ec))
      return Error{ErrorKind::usage, fmt::format("--path '{}': there is no such folder or zip", path)};
  }
  return {};
}

Result<PresetOptions> PresetArguments::options() const {
  PresetOptions options;
  options.paths.assign(paths.begin(), paths.end());
  AFTERGLOW_CHECK(check_paths());
  for (const auto& text : values) {
    AFTERGLOW_TRY(ArgumentValue parsed, parse_argument(text));
    options.arguments.push_back(std::move(parsed));
  }
  for (const auto& text : overrides) {
    AFTERGLOW_TRY(Override parsed, parse_override(text));
    options.overrides.push_back(std::move(parsed));
  }
  if (!at.empty()) {
    AFTERGLOW_TRY(options.at, parse_position(at));
  }
  return options;
}

Result<std::filesystem::path> named_preset(const std::string& name, const std::vector<std::string>& paths) {
  AFTERGLOW_TRY(const std::filesystem::path found, find_preset_file(name, {paths.begin(), paths.end()}));
  std::error_code ec;
  const bool other = found.extension() != ".lua" && std::filesystem::is_regular_file(found, ec);
  if (other && has_pictures(found))
    return Error{ErrorKind::script, "is a picture, not a preset", name, 0, "a Lua file, then the pictures"};
  return found;
}

Result<std::filesystem::path> PresetArguments::preset_file() const { return named_preset(file, paths); }

void PresetArguments::tell_of_namesake(const std::filesystem::path& found, Diagnostics& diagnostics) const {
  std::error_code ec;
  const std::filesystem::path here = file + ".lua";
  if (found == file || here.has_parent_path() || !std::filesystem::is_regular_file(here, ec)) return;
  if (std::filesystem::equivalent(here, found, ec)) return;
  diagnostics.warn_once("namesake", fmt::format("'{}' is {}; {} of this folder is another one: write {} for it", file,
                                                found.string(), here.string(), here.string()));
}

void DeviceArguments::add(CLI::App& command) {
  command.add_option("--device", device, "auto, a number from `afterglow devices`, or part of a device's name")
      ->type_name("DEVICE")
      ->group("Device");
  add_validate(command);
}

void DeviceArguments::add_validate(CLI::App& command) {
  command
      .add_flag("--validate", validate,
                "Vulkan validation with synchronization checks; any error ends with exit code 5")
      ->group("Device");
}

Result<DeviceOptions> DeviceArguments::options() const {
  const char* environment = std::getenv("AFTERGLOW_VALIDATE");
  const bool asked = environment != nullptr && *environment != '\0' && std::string_view(environment) != "0";
  const char* words = std::getenv("AFTERGLOW_FORCE");
  AFTERGLOW_TRY(ForcedWays forced, parse_forced(words ? words : ""));
  return DeviceOptions{.device = device, .validate = validate || asked, .forced = std::move(forced)};
}

void ExecutionArguments::add(CLI::App& command) {
  command
      .add_option("--precision", precision,
                  "Storage between passes: auto, fp32 or fp16 (auto: what is fastest within --max-error)")
      ->check(CLI::IsMember({"auto", "fp32", "fp16"}))
      ->type_name("P")
      ->group("Device");
  add_max_error(command);
  add_calibration(command);
  command.add_flag("--reference", reference, "The slow truth: every pass on its own, full floats, computed weights")
      ->group("Device");
  command
      .add_option(
          "--max-memory", max_memory,
          "Refuse pictures that need more: 512M, 6G (default: 6G, or what the machine or its control group has, if "
          "that is less)")
      ->type_name("SIZE")
      ->group("Device");
}

void ExecutionArguments::add_max_error(CLI::App& command) {
  command
      .add_option(
          "--max-error", max_error,
          "Allowed relative error; 1e-4 and less: full floats, exact sampling (default: the preset's, else 2e-3)")
      ->check(above_zero())
      ->type_name("E")
      ->group("Device");
}

void ExecutionArguments::add_calibration(CLI::App& command) {
  command
      .add_option(
          "--calibration", calibration,
          "Table of `afterglow calibrate` that says how to execute (default: the one that comes with the program)")
      ->type_name("FILE")
      ->group("Device");
}

Result<StackOptions> ExecutionArguments::options() const {
  if (reference && precision == "fp16")
    return Error{ErrorKind::usage, "--reference stores full floats: --precision fp16 cannot be"};
  StackOptions options;
  options.precision = precision == "fp32"   ? Precision::fp32
                      : precision == "fp16" ? Precision::fp16
                                            : Precision::automatic;
  options.max_error = max_error;
  options.reference = reference;
  options.calibration = calibration;
  if (max_memory.empty()) {
    options.max_memory = memory_limit_of_process().bytes;
  } else {
    AFTERGLOW_TRY(options.max_memory, parse_memory(max_memory));
  }
  options.cache_folder = cache_folder();
  return options;
}

Result<Size> parse_size(const std::string& text, const char* option) {
  const auto parts = split(lower(text), 'x');
  Size size;
  const auto number = [](const std::string& part, int& out) {
    out = parse_number<int>(part).value_or(0);
    return out >= 1 && out <= 16384;
  };
  if (parts.size() != 2 || !number(parts[0], size.width) || !number(parts[1], size.height))
    return Error{ErrorKind::usage, fmt::format("'{}' is no size", text), option, 0, "WIDTHxHEIGHT, each 1 to 16384"};
  return size;
}

Result<Rect> parse_region(const std::string& text) {
  const auto parts = split(text, ',');
  std::array<int, 4> numbers{};
  bool good = parts.size() == numbers.size();
  for (std::size_t i = 0; good && i < numbers.size(); ++i) {
    numbers[i] = parse_number<int>(parts[i]).value_or(-1);
    good = numbers[i] >= (i < 2 ? 0 : 1) && numbers[i] <= 16384;
  }
  if (!good)
    return Error{ErrorKind::usage, fmt::format("'{}' is no region", text), "--region", 0,
                 "X,Y,WIDTH,HEIGHT in pixels; X and Y 0 to 16384, WIDTH and HEIGHT 1 to 16384"};
  return Rect{numbers[0], numbers[1], numbers[2], numbers[3]};
}

Result<Position> parse_position(const std::string& text) {
  Position position{};
  const auto parts = split(text, ',');
  bool good = parts.size() == 3;
  for (std::size_t i = 0; good && i < 3; ++i) {
    const auto number = parse_number<double>(trim(parts[i]));
    good = number && std::isfinite(*number);
    if (good) position[i] = *number;
  }
  if (good) return position;
  return Error{ErrorKind::usage, fmt::format("'{}' is no position", text), "--at", 0, "X,Y,Z, three numbers"};
}

Result<std::uint64_t> parse_memory(const std::string& text) {
  const Error wrong{ErrorKind::usage, fmt::format("'{}' is no amount of memory", text), "--max-memory", 0,
                    "a number above 0 with K, M, G or T, as in 512M or 6G"};
  const char* begin = text.c_str();
  char* end = nullptr;
  const double number = std::strtod(begin, &end);
  std::string unit = lower(trim(std::string_view(end)));
  if (end == begin || !std::isfinite(number) || number <= 0) return wrong;
  for (const std::string_view ending : {"ib", "b"})
    if (unit.ends_with(ending)) {
      unit.resize(unit.size() - ending.size());
      break;
    }
  const std::string_view units = "kmgt";
  const auto at = unit.empty() ? 0 : units.find(unit) + 1;
  if (unit.size() > 1 || (!unit.empty() && at == 0)) return wrong;
  const double bytes = number * std::pow(1024.0, static_cast<double>(at));
  if (bytes < 1 || bytes >= 9e18) return wrong;
  return static_cast<std::uint64_t>(bytes);
}

void AssumedPicture::add(CLI::App& command) {
  command.add_option("--size", size, "Size of the assumed picture (default 1920x1080)")
      ->type_name("WxH")
      ->group("Picture");
  command.add_option("--region", region, "Part of the picture that is wanted, as `run` takes it")
      ->type_name("X,Y,W,H")
      ->group("Picture");
  command.add_option("--frame", frame, "Number of the assumed picture in its sequence (default 1)")
      ->check(frame_numbers())
      ->type_name("N")
      ->group("Picture");
  command.add_option("--fps", fps, "Frames a second, for animated presets (default 24)")
      ->transform(frame_rates())
      ->type_name("N")
      ->group("Picture");
  add_repeatable(command, "--without", without,
                 "Auxiliary input that the assumed picture lacks: depth, normal, motion (repeatable)", "INPUT")
      ->group("Picture");
}

Result<BuildContext> AssumedPicture::context(Preset& preset) const {
  AFTERGLOW_TRY(const Size assumed, parse_size(size));
  std::vector<std::string> known{"depth", "normal", "motion"};
  BuildContext context = usual_context(preset, assumed, frame, fps);
  for (const auto& name : preset.needs())
    if (std::find(known.begin(), known.end(), name) == known.end()) known.push_back(name);
  for (const auto& name : without)
    if (std::find(known.begin(), known.end(), name) == known.end())
      return Error{
          ErrorKind::usage,         fmt::format("--without '{}': there is no such input", name), "", 0, join(known),
          nearest_name(name, known)};
  for (const auto& name : without) context.auxiliary.erase(name);
  return context;
}

}  // namespace afterglow
