// SPDX-License-Identifier: MIT
#include "farm/look.h"

#include <algorithm>
#include <memory>
#include <system_error>

#include "core/file.h"
#include "core/hash.h"
#include "graph/history.h"
#include "script/build.h"

namespace afterglow::farm {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostAsked = 64;          // frames of a look that moves that are looked at
constexpr std::size_t kLargestFile = 1u << 30;  // tables and pictures of looks
constexpr Size kUsualSize{1920, 1080};

/// Absolute, and without ".." that would lead out of the pack.
fs::path whole(const fs::path& path) {
  std::error_code ec;
  fs::path out = fs::absolute(path, ec);
  if (std::ranges::find(out, fs::path("..")) != out.end()) out = fs::weakly_canonical(out, ec);
  out = out.lexically_normal();
  return out.has_filename() ? out : out.parent_path();
}

bool is_below(const fs::path& file, const fs::path& folder) {
  if (folder.empty()) return false;
  const fs::path relative = file.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != "..";
}

struct Loaded {
  std::unique_ptr<ShaderLibrary> shaders;
  std::unique_ptr<Preset> preset;
};

Result<Loaded> load(const fs::path& file, const PresetOptions& options, Diagnostics& diagnostics) {
  Loaded out;
  out.shaders = std::make_unique<ShaderLibrary>(search_path_for(file, options.paths));
  AFTERGLOW_TRY(Preset preset, Preset::load(file, options, *out.shaders, diagnostics));
  out.preset = std::make_unique<Preset>(std::move(preset));
  return out;
}

/// Reads the shaders that the frame runs, and those that others may.
Result<void> read_shaders(const Preset& preset, const Graph& graph) {
  ShaderLibrary shaders(preset.path());
  for (const auto& pass : graph.passes)
    for (const auto& name : shaders_of(pass))
      if (auto shader = shaders.find(name); !shader) return std::move(shader).error();
  if (preset.may_change())
    for (const auto& name : shaders.names()) static_cast<void>(shaders.find(name));
  return {};
}

}  // namespace

Result<LoadedLook> load_look(const BatchRequest& request, const std::vector<FrameJob>& frames,
                             Diagnostics& diagnostics) {
  PresetOptions options = request.session.stack.preset;
  for (auto& path : options.paths) path = whole(path);
  options.record = std::make_shared<FileRecord>();
  const fs::path file = whole(request.preset);
  AFTERGLOW_TRY(const Loaded look, load(file, options, diagnostics));
  Preset& preset = *look.preset;
  LoadedLook out;
  const std::size_t asked = preset.may_change() ? std::min(frames.size(), kMostAsked) : 1;
  for (std::size_t i = 0; i < asked; ++i) {
    const double frame = frames[i * frames.size() / asked].frame;
    AFTERGLOW_TRY(const Build build,
                  preset.evaluate(usual_context(preset, kUsualSize, frame, request.loop.fps), diagnostics));
    if (!build.graph.histories.empty())
      out.pre_roll = std::max(out.pre_roll.value_or(0), request.pre_roll.value_or(pre_roll(build.graph)));
    AFTERGLOW_CHECK(read_shaders(preset, build.graph));
  }
  const fs::path& installation = preset.path().installation;
  std::error_code ec;
  for (const auto& [path, probe] : *preset.probes()) {
    const fs::path seen = path.lexically_normal();
    if (is_below(seen, installation) && !is_below(seen, file.parent_path())) continue;
    if (fs::is_regular_file(seen, ec)) out.files.push_back(seen);
    if (fs::is_directory(seen, ec)) out.folders.push_back(seen);
  }
  if (std::ranges::count(out.files, file) == 0) out.files.push_back(file);
  // Of the search path each folder, whether or not anything of it is read.
  for (const auto& path : options.paths)
    if (fs::is_directory(path, ec)) out.folders.push_back(path);
  return out;
}

fs::path packed_place(const fs::path& folder, const fs::path& file) {
  return folder / "look" / "files" / whole(file).relative_path();
}

Result<void> pack_file(const fs::path& file, const std::string& name, Job& job) {
  AFTERGLOW_TRY(const std::string content, read_file(file, kLargestFile));
  std::error_code ec;
  const fs::path place = job.folder / name;
  fs::create_directories(place.parent_path(), ec);
  AFTERGLOW_CHECK(write_file_atomically(place, content));
  job.files[name] = hash_text(content).hex();
  return {};
}

Result<void> pack_look(const LoadedLook& look, Job& job) {
  std::error_code ec;
  for (const auto& folder : look.folders) fs::create_directories(packed_place(job.folder, folder), ec);
  for (const auto& file : look.files)
    AFTERGLOW_CHECK(pack_file(file, packed_place(job.folder, file).lexically_relative(job.folder).string(), job));
  return {};
}

Result<void> lock_packed_look(const BatchRequest& request, const fs::path& locked, Job& job, Diagnostics& diagnostics) {
  AFTERGLOW_TRY(const Loaded look, load(request.preset, request.session.stack.preset, diagnostics));
  const BuildContext usual = usual_context(*look.preset, kUsualSize, 1, request.loop.fps);
  AFTERGLOW_TRY(const Build build, look.preset->evaluate(usual, diagnostics));
  AFTERGLOW_TRY(const Lock lock, look_lock(*look.preset, request.preset, build.graph, request.pixel_options));
  if (!locked.empty()) {
    AFTERGLOW_TRY(const Lock given, read_lock(locked));
    AFTERGLOW_CHECK(hold_against(given, lock, locked, diagnostics));
  }
  const std::string text = lock_text(lock);
  AFTERGLOW_CHECK(write_file_atomically(job.folder / "look" / "lock.json", text));
  job.files["look/lock.json"] = hash_text(text).hex();
  return {};
}

}  // namespace afterglow::farm
