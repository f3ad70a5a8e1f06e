// SPDX-License-Identifier: MIT
// Shaders that no file holds: made while a preset is evaluated, and found by their names like those of files.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace afterglow {

struct MadeShader {
  std::string text;
  std::filesystem::path origin;  ///< the file that it was made of
};

/// Thread-safe.
class MadeShaders {
 public:
  void add(const std::string& name, MadeShader shader) {
    const std::lock_guard lock(mutex_);
    shaders_.insert_or_assign(name, std::move(shader));
  }
  std::optional<MadeShader> find(const std::string& name) const {
    const std::lock_guard lock(mutex_);
    const auto found = shaders_.find(name);
    return found == shaders_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::string, MadeShader> shaders_;
};

}  // namespace afterglow
