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
#include "session/session.h"

namespace afterglow {

/// -v, -q, --no-color: every command has them.
struct MessageArguments {
  bool verbose = false, quiet = false, no_color = false;
  void add(CLI::App& command);
  void apply(Console& console) const;
};

/// PRESET, --set, --at, --path.
struct PresetArguments {
  std::string file;
  std::vector<std::string> overrides;
  std::vector<std::string> values;  ///< --arg
  std::string at;
  std::vector<std::string> paths;
  void add(CLI::App& command);
  void add_paths(CLI::App& command);  ///< --path alone
  Result<PresetOptions> options() const;
  /// The file that PRESET means: see find_preset_file. Errors: script.
  Result<std::filesystem::path> preset_file() const;
};

/// --device, --validate (or AFTERGLOW_VALIDATE=1), and AFTERGLOW_FORCE.
struct DeviceArguments {
  std::string device = "auto";
  bool validate = false;
  void add(CLI::App& command);
  /// Errors: usage (words of AFTERGLOW_FORCE).
  Result<DeviceOptions> options() const;
};

/// --precision, --max-error, --calibration, --reference, --max-memory.
struct ExecutionArguments {
  std::string precision = "auto";
  std::optional<double> max_error;
  bool reference = false;
  std::string max_memory = "6G";
  std::string calibration;
  void add(CLI::App& command);
  /// Everything of StackOptions but the preset. Errors: usage.
  Result<StackOptions> options() const;
};

/// "1920x1080". Errors: usage.
Result<Size> parse_size(const std::string& text);
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
  Result<BuildContext> context(const Preset& preset) const;
};

}  // namespace afterglow
