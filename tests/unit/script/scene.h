// SPDX-License-Identifier: MIT
// A folder with a preset, effects and shaders for one test, and what comes out of them.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "script/build.h"

namespace afterglow::test {

class Scene {
 public:
  Scene();
  ~Scene();

  std::filesystem::path folder() const { return folder_; }
  std::filesystem::path write(const std::string& name, const std::string& text);
  /// An effect file whose fx.effect table has these lines after the name; it starts with `local fx = require
  /// "afterglow"`.
  void effect(const std::string& name, const std::string& body);
  void preset(const std::string& text) { write("preset.lua", text); }
  /// `local fx = require "afterglow"`, a newline, `return fx.stack {`, a newline, the text, `}`: its first line is
  /// line 3.
  void stack(const std::string& entries);

  Result<Preset> load();
  /// Text of the error of loading, with the folder's name cut out; "" when there is none.
  std::string load_error();
  Result<Build> evaluate(Preset& preset);
  Result<Graph> build(Preset& preset);
  /// Loads and builds; text of the error of either.
  std::string build_error();
  /// Loads and builds; fails the test when that fails.
  Graph graph();

  /// The text without the name of this folder.
  std::string shorten(std::string text) const;

  PresetOptions options;
  BuildContext context{{64, 32}, {}, 1, 0, 24};
  std::vector<std::string> notes, warnings;
  Diagnostics diagnostics;
  std::unique_ptr<ShaderLibrary> shaders;

 private:
  std::filesystem::path folder_;
};

}  // namespace afterglow::test
