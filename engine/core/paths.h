// Where effects, shaders, presets and caches live.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace afterglow {

/// The folders in which a name is looked up, in order: beside the preset, each --path, each entry of AFTERGLOW_PATH,
/// the installation. The first three hold `effects/NAME.lua` and `shaders/…`; the installation holds
/// `scripts/effects/NAME.lua` and `shaders/…` and comes last.
struct SearchPath {
  std::vector<std::filesystem::path> user;  ///< in order of precedence
  std::filesystem::path installation;       ///< folder that holds scripts/, shaders/, presets/

  /// `effects/NAME.lua` or the installation's `scripts/effects/NAME.lua`; all hits, the winner first.
  std::vector<std::filesystem::path> find_effect(const std::string& name) const;
  /// `shaders/NAME` (with extension, e.g. "glow/threshold.glsl"); all hits, the winner first.
  std::vector<std::filesystem::path> find_shader(const std::string& name) const;
  /// The preset of that name: `NAME.lua` or `NAME/NAME.lua`, in each folder itself and in its `presets/`; all hits, the
  /// winner first. Names are letters, digits, '_' and '-'.
  std::vector<std::filesystem::path> find_preset(const std::string& name) const;
  /// Names that `find_preset` knows, sorted.
  std::vector<std::string> preset_names() const;
  /// Folders that may hold effect scripts, in order.
  std::vector<std::filesystem::path> effect_folders() const;
  /// Folders that may hold presets, in order.
  std::vector<std::filesystem::path> preset_folders() const;
};

/// The folder with scripts/, shaders/ and presets/: AFTERGLOW_HOME, else found from the running binary
/// (`BIN/../share/afterglow`, or the source tree the binary was built from). Empty when there is none.
std::filesystem::path find_installation();

/// Search path for a preset file; `extra` are the --path options. AFTERGLOW_PATH is split at ':'.
SearchPath search_path_for(const std::filesystem::path& preset, const std::vector<std::filesystem::path>& extra);

/// Folder for disk caches: AFTERGLOW_CACHE, else XDG_CACHE_HOME/afterglow, else HOME/.cache/afterglow, else a
/// folder of the user's under the system's temporary folder. Not created.
std::filesystem::path cache_folder();

}  // namespace afterglow
