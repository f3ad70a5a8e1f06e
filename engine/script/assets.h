// SPDX-License-Identifier: MIT
// Files that effects read besides scripts and shaders: look-up tables, pictures. A name goes inside of the folders that
// scripts may read, and nowhere else.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/image_data.h"
#include "image/ocio.h"
#include "script/asset_store.h"
#include "script/dependencies.h"

struct lua_State;

namespace afterglow::script {

struct Runtime;

/// A table that was read, and its numbers as an image.
struct LoadedLut {
  std::vector<LutStep> steps;
  std::shared_ptr<const ImageData> table;
  bool unit = false;  ///< see gives_unit (image/lut_file.h)
};

/// A part of a configuration of OpenColorIO, as a shader.
struct LoadedOcio {
  std::string shader;                      ///< its name for g:pass
  std::string text;                        ///< of the shader
  std::shared_ptr<const ImageData> table;  ///< that it reads; null: none
  std::filesystem::path config;
  Dependencies depends;  ///< on what it was made of
};

/// A picture that was read.
struct ReadPicture {
  std::shared_ptr<const ImageData> data;
  std::optional<Hash> key;  ///< of the store; none: it has none
  std::uint64_t used = 0;   ///< Assets::uses of the last time
};

/// What one state has read: a file is read once, so that every build of a preset sees the same. Pictures that no graph
/// holds any more may go when others need the room.
struct Assets {
  /// By name and the script that gives it, with what Dependencies::files says of it: a file that is gone later is the
  /// one that was found as long as the state lives.
  std::map<std::pair<std::string, std::string>, std::pair<std::filesystem::path, std::string>> found;
  /// By file and correction.
  std::map<std::pair<std::filesystem::path, std::string>, std::shared_ptr<const LoadedLut>> luts;
  std::map<std::string, std::shared_ptr<const LoadedOcio>> ocio;           ///< by request
  std::map<std::pair<std::filesystem::path, bool>, ReadPicture> pictures;  ///< `raw` or not
  std::uint64_t uses = 0;                                                  ///< of pictures, counted
  std::size_t bytes = 0;
  std::shared_ptr<AssetStore> store;  ///< what other states have read
  std::uint64_t look = 0;             ///< the store's number of this one; 0: it has asked for nothing yet
};

/// The file of that name beside the preset, along the search path, in the installation's assets/; links that lead out
/// of a folder are refused. An absolute path only when it is what the command line gave for a setting of the entry that
/// is being built. Errors: throws ScriptError, at the setting that gave the name.
std::filesystem::path find_asset(lua_State* lua, const std::string& what, const std::string& name);

/// Errors: throw ScriptError (see read_lut, read_picture; too much in all).
const LoadedLut& load_lut(lua_State* lua, const std::filesystem::path& file, const std::string& correction);
/// `raw`: see ReadOptions.
std::shared_ptr<const ImageData> load_picture(lua_State* lua, const std::filesystem::path& file, bool raw);

// ---- what those need who read files of other kinds

/// Something is wrong with a value that a script passed on.
struct AssetFault {
  std::string key, value;  ///< of the call: "file", "film.cube"
  std::string why, allowed, nearest;
};
/// Throws, at the setting of the entry being built where the value comes from, else at the call. `what` names the call.
[[noreturn]] void fail_at(lua_State* lua, const std::string& what, const AssetFault& fault);

/// Does it lie in a folder that scripts may read?
bool may_read(const Runtime& runtime, const std::filesystem::path& file);
/// Did the command line give this as a file for a setting of the entry being built? Then it may be any file.
bool is_given_by_command(const Runtime& runtime, const std::string& name);
std::shared_ptr<const ImageData> make_data(Size size, std::vector<float> pixels, const std::filesystem::path& file,
                                           bool opaque = false);
/// Counts data that the state is to hold; null is nothing. Pictures that no graph holds make room. Errors: throws
/// ScriptError, when all of it takes too much memory.
void count_data(Runtime& runtime, const ImageData* data);
/// What the file held when this look, or whoever it shares a record with, read it first. None: it cannot be read.
std::optional<Hash> content_seen(const Runtime& runtime, const std::filesystem::path& file, std::size_t limit);
/// The state's number in its store.
std::uint64_t look_of(Runtime& runtime);

}  // namespace afterglow::script
