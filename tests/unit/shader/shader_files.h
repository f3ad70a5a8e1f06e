// SPDX-License-Identifier: MIT
// A folder of shader files that lives as long as a test, and short ways to use it.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "shader/kernel.h"
#include "shader/library.h"

namespace afterglow {

class ShaderFiles {
 public:
  ShaderFiles() {
    std::string pattern = (std::filesystem::temp_directory_path() / "afterglow-shader-XXXXXX").string();
    root_ = mkdtemp(pattern.data());
  }
  ~ShaderFiles() {
    std::error_code ec;
    std::filesystem::remove_all(root_, ec);
  }
  ShaderFiles(const ShaderFiles&) = delete;
  ShaderFiles& operator=(const ShaderFiles&) = delete;

  const std::filesystem::path& root() const { return root_; }
  std::filesystem::path path(const std::string& name) const { return root_ / "shaders" / name; }

  /// `name` with extension, below shaders/.
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(path(name).parent_path());
    std::ofstream(path(name), std::ios::binary) << text;
  }

  SearchPath search() const {
    SearchPath path;
    path.user = {root_};
    return path;
  }

  /// Writes a shader "test/NAME" and finds it with a fresh library.
  Result<std::shared_ptr<const ShaderSource>> find(const std::string& name, const std::string& text) const {
    write(name + ".glsl", text);
    return ShaderLibrary(search()).find(name);
  }

  /// The same for a shader that must be right.
  KernelStage stage(const std::string& name, const std::string& text,
                    std::map<std::string, double> constants = {}) const {
    auto source = find(name, text);
    if (!source) {
      ADD_FAILURE() << source.error().text();
      return {};
    }
    return {*source, std::move(constants), name};
  }

 private:
  std::filesystem::path root_;
};

/// A kernel of one shader.
inline KernelDesc one(KernelStage stage) {
  KernelDesc kernel;
  if (info_of(stage.shader->interface.kind).begins) {
    kernel.sample = std::move(stage);
  } else {
    kernel.stages.push_back(std::move(stage));
  }
  return kernel;
}

}  // namespace afterglow
