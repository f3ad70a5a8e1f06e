// SPDX-License-Identifier: MIT
#include "bad_effects.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace afterglow::stress {
namespace fs = std::filesystem;
namespace {

struct World {
  Diagnostics diagnostics;
  std::unique_ptr<Device> device;
  std::unique_ptr<Harness> harness;
  World() {
    setenv("AFTERGLOW_HOME", AFTERGLOW_PROJECT_FOLDER, 1);
    setenv("XDG_RUNTIME_DIR", testing::TempDir().c_str(), 0);
    auto made = Device::create({.device = "auto", .validate = true}, diagnostics);
    if (!made) throw std::runtime_error(made.error().text());
    device = std::move(*made);
    auto a_lab = Harness::create(*device, {}, diagnostics);
    if (!a_lab) throw std::runtime_error(a_lab.error().text());
    harness = std::move(*a_lab);
  }
};

World& world() {
  static World one;
  return one;
}

}  // namespace

EffectFolder::EffectFolder() {
  std::string pattern = (fs::temp_directory_path() / "afterglow-bad-XXXXXX").string();
  if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

EffectFolder::~EffectFolder() {
  std::error_code ec;
  fs::remove_all(path_, ec);
}

void EffectFolder::write(const std::string& file, const std::string& text) const {
  fs::create_directories((path_ / file).parent_path());
  std::ofstream(path_ / file, std::ios::binary) << text;
}

void EffectFolder::effect(const std::string& name, const std::string& glsl, const std::string& more,
                          const std::string& pass) const {
  write("effects/" + name + ".lua", fmt::format(R"(local fx = require "afterglow"
return fx.effect {{
  name = "{0}", doc = "Made for a test.",
  settings = {{
    strength = fx.float {{ min = 0, max = 1, default = 0.5 }},
    level = fx.float {{ min = 0, max = 10, default = 1 }},
  }},
  {1}
  build = function(g, s, source)
    return g:pass {{ shader = "{0}/{0}", source = source, strength = s.strength, level = s.level, {2} }}
  end,
}}
)",
                                                name, more, pass));
  write(fmt::format("shaders/{0}/{0}.glsl", name), "uniform float strength;\nuniform float level;\n" + glsl + "\n");
}

Look EffectFolder::look(const std::string& effect) const {
  return {{{.effect = effect, .settings = {}, .at = {}}}, {path_}};
}

Harness& harness() { return *world().harness; }
int validation_errors() { return world().device->validation_errors(); }

Situation situation(const Look& look, const std::string& check, const PictureSpec& picture, std::uint64_t seed) {
  return {.look = look, .picture = make_picture(picture), .frame = 1, .check = check, .seed = seed};
}

Outcome outcome_of(const Situation& s) {
  harness().forget();
  auto outcome = run_check(harness(), s);
  if (!outcome) {
    ADD_FAILURE() << outcome.error().text();
    return {};
  }
  return *outcome;
}

}  // namespace afterglow::stress
