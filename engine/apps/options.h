// SPDX-License-Identifier: MIT
// Options that several commands share: declared once, with one text of help.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/console.h"
#include "core/geometry.h"
#include "core/result.h"
#include "image/reader.h"
#include "session/session.h"

namespace afterglow {

/// -v, -q, --no-color: every command has them.
struct MessageArguments {
  bool verbose = false, quiet = false, no_color = false;
  void add(CLI::App& command);
  void apply(Console& console) const;
};

/// Numbers above 0. (CLI11's own tells of them as "0.000000 to 1797…", 308 digits.)
CLI::Validator above_zero();
/// Takes a finite number, as frames have.
CLI::Validator frame_numbers();

/// Rates that videos can have (kSlowestRate).
CLI::Validator frame_rates();

/// --cuts, for parse_cuts; empty: videos are looked at.
void add_cuts(CLI::App& command, std::string& into, const std::string& group);

/// An option that may be given several times, with one value each.
CLI::Option* add_repeatable(CLI::App& command, const std::string& name, std::vector<std::string>& into,
                            const std::string& help, const char* type);

/// The file that the name of a preset on a command line means: see find_preset_file. Errors: script (none, a picture).
Result<std::filesystem::path> named_preset(const std::string& name, const std::vector<std::string>& paths);

/// PRESET, --set, --at, --arg, --path.
struct PresetArguments {
  std::string file;
  std::vector<std::string> overrides;
  std::vector<std::string> values;  ///< --arg
  std::string at;
  std::vector<std::string> paths;
  void add(CLI::App& command);
  void add_overrides(CLI::App& command);  ///< --set alone
  void add_paths(CLI::App& command);      ///< --path alone
  Result<void> check_paths() const;       ///< Errors: usage (--path)
  Result<PresetOptions> options() const;
  /// The file that PRESET means.
  Result<std::filesystem::path> preset_file() const;
  /// Warns, once, where PRESET is a name and a file NAME.lua of the current folder was not taken for it.
  void tell_of_namesake(const std::filesystem::path& found, Diagnostics& diagnostics) const;
};

/// --layer, --input-space, --gamut, --overscan, --depth, --normal, --motion, --mattes: where the parts of a picture
/// come from, and how it is stored.
struct LayerArguments {
  std::string layer, input_space, gamut, overscan = "keep", depth, normal, motion, mattes;
  void add(CLI::App& command);
  /// What every picture of a command is read with.
  void choose_reading(ReadOptions& options) const;
  /// Into what takes them: ReadOptions, FrameListRequest.
  template <class Request>
  void choose(Request& request) const {
    if (!depth.empty()) request.depth = parse_layer_choice(depth);
    if (!normal.empty()) request.normal = parse_layer_choice(normal);
    if (!motion.empty()) request.motion = parse_layer_choice(motion);
  }
};

/// --device, --validate (or AFTERGLOW_VALIDATE=1), and AFTERGLOW_FORCE.
struct DeviceArguments {
  std::string device = "auto";
  bool validate = false;
  void add(CLI::App& command);
  void add_validate(CLI::App& command);  ///< --validate alone
  /// Errors: usage (words of AFTERGLOW_FORCE).
  Result<DeviceOptions> options() const;
};

/// --precision, --max-error, --calibration, --reference, --max-memory.
struct ExecutionArguments {
  std::string precision = "auto";
  std::optional<double> max_error;
  bool reference = false;
  std::string max_memory;  ///< empty: memory_limit_of_process
  std::string calibration;
  void add(CLI::App& command);
  void add_max_error(CLI::App& command);    ///< --max-error alone
  void add_calibration(CLI::App& command);  ///< --calibration alone
  /// Everything of StackOptions but the preset. Errors: usage.
  Result<StackOptions> options() const;
};

/// "1920x1080". Errors: usage.
Result<Size> parse_size(const std::string& text, const char* option = "--size");
/// "X,Y,W,H": whole numbers, X and Y not negative, W and H at least 1. Errors: usage.
Result<Rect> parse_region(const std::string& text);
/// "6G", "512M", "1.5GiB", "1000000": bytes, units of 1024. Errors: usage.
Result<std::uint64_t> parse_memory(const std::string& text);

/// "1,-2.5,3". Errors: usage.
Result<Position> parse_position(const std::string& text);

/// The picture that `check`, `graph` and `explain` assume: --size, --frame, --fps, with every auxiliary input that the
/// stack asks for.
struct AssumedPicture {
  std::string size = "1920x1080";
  std::string region;  ///< --region; empty: all
  double frame = 1, fps = 24;
  std::vector<std::string> without;  ///< --without depth
  void add(CLI::App& command);
  Result<BuildContext> context(Preset& preset) const;
};

}  // namespace afterglow
