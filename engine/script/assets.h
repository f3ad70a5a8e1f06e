// Files that effects read besides scripts and shaders: look-up tables, pictures. A name goes inside of the folders that
// scripts may read, and nowhere else.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "core/image_data.h"
#include "image/lut_file.h"

struct lua_State;

namespace afterglow::script {

/// A table that was read, and its numbers as an image.
struct LoadedLut {
  std::vector<LutStep> steps;
  std::shared_ptr<const ImageData> table;
};

/// What one state has read: a file is read once, so that every build of a preset sees the same.
struct Assets {
  std::map<std::filesystem::path, LoadedLut> luts;
  std::map<std::filesystem::path, std::shared_ptr<const ImageData>> pictures;
  std::size_t bytes = 0;
};

/// The file of that name beside the preset, along the search path, in the installation's assets/; links that lead out
/// of a folder are refused. An absolute path only when it is what the command line gave for a setting of the entry that
/// is being built. Errors: throws ScriptError, at the setting that gave the name.
std::filesystem::path find_asset(lua_State* lua, const std::string& what, const std::string& name);

/// Errors: throw ScriptError (see read_lut, read_picture; too much in all).
const LoadedLut& load_lut(lua_State* lua, const std::filesystem::path& file);
std::shared_ptr<const ImageData> load_picture(lua_State* lua, const std::filesystem::path& file);

}  // namespace afterglow::script
