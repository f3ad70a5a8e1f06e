// SPDX-License-Identifier: MIT
#include "scene.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace afterglow::test {
namespace fs = std::filesystem;

Scene::Scene()
    : diagnostics([this](Severity severity, const std::string& text) {
        (severity == Severity::warning ? warnings : notes).push_back(shorten(text));
      }) {
  static int count = 0;
  folder_ =
      fs::temp_directory_path() / ("afterglow_script_" + std::to_string(getpid()) + "_" + std::to_string(count++));
  fs::create_directories(folder_);
}

Scene::~Scene() {
  std::error_code ec;
  fs::remove_all(folder_, ec);
}

fs::path Scene::write(const std::string& name, const std::string& text) {
  const fs::path file = folder_ / name;
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

void Scene::effect(const std::string& name, const std::string& body) {
  write("effects/" + name + ".lua",
        "local fx = require \"afterglow\"\nreturn fx.effect { name = \"" + name + "\",\n" + body + "\n}\n");
}

void Scene::stack(const std::string& entries) {
  preset("local fx = require \"afterglow\"\nreturn fx.stack {\n" + entries + "\n}\n");
}

Result<Preset> Scene::load() {
  shaders = std::make_unique<ShaderLibrary>(search_path_for(folder_ / "preset.lua", options.paths));
  return Preset::load(folder_ / "preset.lua", options, *shaders, diagnostics);
}

std::string Scene::load_error() {
  auto preset = load();
  return preset ? "" : shorten(preset.error().text());
}

Result<Build> Scene::evaluate(Preset& preset) { return preset.evaluate(context, diagnostics); }

Result<Graph> Scene::build(Preset& preset) {
  AFTERGLOW_TRY(Build made, evaluate(preset));
  return std::move(made.graph);
}

std::string Scene::build_error() {
  auto preset = load();
  if (!preset) return shorten(preset.error().text());
  auto graph = build(*preset);
  return graph ? "" : shorten(graph.error().text());
}

Graph Scene::graph() {
  auto preset = load();
  if (!preset) {
    ADD_FAILURE() << preset.error().text();
    return {};
  }
  auto graph = build(*preset);
  if (!graph) {
    ADD_FAILURE() << graph.error().text();
    return {};
  }
  return *graph;
}

std::string Scene::shorten(std::string text) const {
  const std::string prefix = folder_.string() + "/";
  for (std::size_t at; (at = text.find(prefix)) != std::string::npos;) text.erase(at, prefix.size());
  return text;
}

}  // namespace afterglow::test
