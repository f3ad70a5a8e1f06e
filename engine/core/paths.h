// SPDX-License-Identifier: MIT
// Where effects, shaders, presets and caches live.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/result.h"

namespace afterglow {

class FileRecord;   // core/file_record.h
class MadeShaders;  // core/made_shaders.h

/// The folders in which a name is looked up, in order: beside the preset, each --path, each entry of AFTERGLOW_PATH,
/// the installation. The first three hold `effects/NAME.lua` and `shaders/…`; the installation holds
/// `scripts/effects/NAME.lua` and `shaders/…` and comes last.
struct SearchPath {
  std::vector<std::filesystem::path> user;  ///< in order of precedence
  std::filesystem::path installation;       ///< folder that holds scripts/, shaders/, presets/
  std::optional<Error> error = {};          ///< of a pack that cannot be used: loading a preset fails with it
  /// Takes down what is looked at along the path, here and by those who read what was found. Null: nothing is.
  std::shared_ptr<FileRecord> record = {};
  /// Shaders that were made for the preset that this path is of; they go before those of files. Null: none.
  std::shared_ptr<MadeShaders> made = {};
  std::set<std::filesystem::path> packs = {};  ///< those of `user` that a folder's packs/ holds

  /// `effects/NAME.lua` or the installation's `scripts/effects/NAME.lua`; all hits, the winner first.
  std::vector<std::filesystem::path> find_effect(const std::string& name) const { return find_script(name, "effects"); }
  /// The same in folders of another name: `masks/NAME.lua`, `scripts/masks/NAME.lua`.
  std::vector<std::filesystem::path> find_script(const std::string& name, const std::string& folder) const;
  /// `shaders/NAME` (with extension, e.g. "glow/threshold.glsl"); all hits, the winner first: what lies in packs/ comes
  /// behind the installation, so that a pack changes no effect but its own. Of the file that asks for it (`from`) the
  /// own folder goes before all others.
  std::vector<std::filesystem::path> find_shader(const std::string& name, const std::filesystem::path& from = {}) const;
  /// The folders of `user` that a script lies in, the deepest first; none of scripts of the installation.
  std::vector<std::filesystem::path> folders_of(const std::filesystem::path& script) const;
  /// Folders in which files are found that scripts name, like "luts/film.cube"; those of the installation lie in
  /// assets/.
  std::vector<std::filesystem::path> asset_folders() const;
  /// The file of such a name; empty: there is none.
  std::filesystem::path find_asset(const std::string& name) const;
  /// The preset of that name: `NAME.lua` or `NAME/NAME.lua`, in each folder itself and in its `presets/`; all hits, the
  /// winner first. Names are letters, digits, '_' and '-'.
  std::vector<std::filesystem::path> find_preset(const std::string& name) const;
  /// Names that `find_preset` knows, sorted.
  std::vector<std::string> preset_names() const;
  /// Folders that may hold scripts of a kind (`effects`, `masks`), in order.
  std::vector<std::filesystem::path> script_folders(const std::string& folder) const;
  /// Folders that may hold presets, in order.
  std::vector<std::filesystem::path> preset_folders() const;
};

/// The folder with scripts/, shaders/ and presets/: AFTERGLOW_HOME, else `share/afterglow` in a folder above the
/// program or library that this code is part of, else below the prefix that it was built for; the source tree for
/// what has not been installed. Empty when there is none.
std::filesystem::path find_installation();

/// Does it come along with Afterglow: is it below presets/ or packs/ of the installation?
bool is_of_installation(const std::filesystem::path& preset);

/// The folders that belong to a preset: its own; of a preset in `presets/`, also the one above when that holds
/// `effects/`, `shaders/` or `luts/`.
std::vector<std::filesystem::path> folders_of_preset(const std::filesystem::path& preset);

/// Search path for a preset file; `extra` are the --path options. AFTERGLOW_PATH is split at ':'. Both may name zips.
/// Behind each folder come the packs (folders and zips) in its `packs/`, by name; those of the installation come last.
/// `record` becomes the path's. `installation`: what find_installation says, unless it is given.
SearchPath search_path_for(const std::filesystem::path& preset, const std::vector<std::filesystem::path>& extra,
                           std::shared_ptr<FileRecord> record = nullptr,
                           const std::filesystem::path& installation = {});

/// The preset that a user means: a file as it is; a pack (folder or zip) that holds one preset or one of its own name;
/// the name of a preset in `extra`, AFTERGLOW_PATH or the installation. A file that does not exist comes back as it is.
/// Errors: script (unknown name, with the nearest; no installation; a pack that is refused, or with several presets).
Result<std::filesystem::path> find_preset_file(const std::string& given,
                                               const std::vector<std::filesystem::path>& extra,
                                               const std::filesystem::path& installation = {});

/// Folder for disk caches: AFTERGLOW_CACHE, else user_cache_folder if it can be written to (neither is created), else
/// one below the temporary folder, made here, that is this user's and that nobody else may write to.
std::filesystem::path cache_folder();

}  // namespace afterglow
