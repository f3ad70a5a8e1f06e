// SPDX-License-Identifier: MIT
// What the passes of a frame were made of besides scripts and shaders: effects choose it while they build.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/hash.h"
#include "image/cryptomatte.h"

namespace afterglow {

struct Dependencies {
  /// Tables, pictures, configurations of OpenColorIO and their tables: the name that a script gave, by the file that
  /// was found for it. Such names are looked up along the search path; kOcioVariable: in the environment; empty: a
  /// configuration or the command line names the file itself.
  std::map<std::filesystem::path, std::string> files;
  /// Beside the frame's picture, whose header names them; there or not.
  std::set<std::filesystem::path> beside;
  /// Variables of the environment that say what a configuration means; empty: not set.
  std::map<std::string, std::string> environment;
  /// Shaders that were made and their tables, by the request: "config.ocio, from lin, display sRGB".
  std::map<std::string, Hash> generated;
  /// Of masks, which select nothing where the picture has no such ids.
  std::vector<CryptomatteObject> objects;

  void add(const Dependencies& more) {
    for (const auto& [file, name] : more.files) files.emplace(file, name);
    beside.insert(more.beside.begin(), more.beside.end());
    for (const auto& [name, value] : more.environment) environment.emplace(name, value);
    for (const auto& [name, hash] : more.generated) generated.emplace(name, hash);
    objects.insert(objects.end(), more.objects.begin(), more.objects.end());
  }
};

inline constexpr const char* kOcioVariable = "$OCIO";

}  // namespace afterglow
