// SPDX-License-Identifier: MIT
// A preset with effects, modules and shaders beside it: loaded and built, without a device.
#include <fmt/format.h>

#include "fuzz.h"
#include "graph/plan.h"
#include "script/build.h"
#include "script/explanation.h"

using namespace afterglow;

namespace {

/// Names that a script could ask for; others would leave the folder or never be read.
bool is_file_name(const std::string& name) {
  if (name.empty() || name.size() > 40 || name[0] == '/' || name[0] == '.') return false;
  for (const char c : name)
    if (!(c == '/' || c == '_' || c == '.' || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))) return false;
  return name.find("..") == std::string::npos && name.find("//") == std::string::npos && name.back() != '/';
}

void build(Preset& preset, double frame) {
  Diagnostics silent;
  BuildContext context{{64, 32}, {{"depth", {64, 32}}, {"normal", {64, 32}}}, frame, frame / 24, 24};
  const auto made = preset.evaluate(context, silent);
  if (!made) return fuzz::check_error(made.error(), {ErrorKind::script});
  const auto valid = validate(made->graph);
  FUZZ_CLAIM(valid.ok(), valid.ok() ? "" : valid.error().text());
  FUZZ_CLAIM(!to_json(made->graph).empty(), "");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::error_code ec;
  for (const char* folder : {"effects", "shaders", "lib", "presets"})
    std::filesystem::remove_all(fuzz::scratch() / folder, ec);
  const auto files = fuzz::split_files(fuzz::text_of(data, size));
  for (std::size_t i = 1; i < files.size() && i < 8; ++i)
    if (is_file_name(files[i].name)) fuzz::write(files[i].name, files[i].text);

  const auto file = fuzz::scratch() / "preset.lua";
  ShaderLibrary shaders(search_path_for(file, {}));
  PresetOptions options;
  options.text = std::string(files[0].text);
  options.limits = {8u << 20, 300'000, 60};
  Diagnostics silent;
  auto preset = Preset::load(file, options, shaders, silent);
  if (!preset) {
    fuzz::check_error(preset.error(), {ErrorKind::script});
    FUZZ_CLAIM(!preset.error().file.empty(), preset.error().text());
    return 0;
  }
  build(*preset, 1);
  build(*preset, 7);
  FUZZ_CLAIM(preset->memory_used() <= options.limits.memory, fmt::format("{}", preset->memory_used()));
  return 0;
}
