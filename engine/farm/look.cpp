// SPDX-License-Identifier: MIT
#include "farm/look.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <system_error>

#include "core/file.h"
#include "core/hash.h"
#include "core/inside.h"
#include "core/temporary.h"
#include "graph/history.h"
#include "script/build.h"

namespace afterglow::farm {
namespace {

namespace fs = std::filesystem;

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

Result<Inventory> inventory_of(Preset& preset, const std::vector<FrameJob>& frames, const FrameLoopOptions& loop,
                               Diagnostics& diagnostics, const EachBuild& each = {}) {
  std::vector<const FrameJob*> jobs;
  for (const auto& frame : frames) jobs.push_back(&frame);
  return take_inventory(preset, usual_contexts(preset, jobs, loop.fps, first_header(jobs, loop.read)), diagnostics,
                        each);
}

}  // namespace

Result<LoadedLook> load_look(const BatchRequest& request, const std::vector<FrameJob>& frames,
                             Diagnostics& diagnostics) {
  PresetOptions options = request.session.stack.preset;
  for (auto& path : options.paths) path = whole_path(path);
  options.record = std::make_shared<FileRecord>();
  const fs::path file = whole_path(request.preset);
  AFTERGLOW_TRY(const Loaded look, load(file, options, diagnostics));
  Preset& preset = *look.preset;
  LoadedLook out;
  const auto each = [&](const Build& build) {
    if (!build.graph.histories.empty())
      out.pre_roll = std::max(out.pre_roll.value_or(0), request.pre_roll.value_or(pre_roll(build.graph)));
  };
  AFTERGLOW_TRY(const Inventory inventory, inventory_of(preset, frames, request.loop, diagnostics, each));
  out.environment = inventory.depends.environment;
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
  return folder / "look" / "files" / whole_path(file).relative_path();
}

Result<void> pack_file(const fs::path& file, const std::string& name, Job& job) {
  const fs::path place = job.folder / name;
  std::error_code ec;
  fs::create_directories(place.parent_path(), ec);
  Temporary copy(place);
  fs::copy_file(file, copy.path(), ec);
  if (ec)
    return Error{ErrorKind::io, fmt::format("cannot be copied to {}: {}", place.string(), ec.message()), file.string()};
  AFTERGLOW_CHECK(copy.commit());
  AFTERGLOW_TRY(const Hash hash, hash_file(place));
  job.files[name] = hash.hex();
  return {};
}

Result<void> pack_look(const LoadedLook& look, Job& job) {
  std::error_code ec;
  for (const auto& folder : look.folders) fs::create_directories(packed_place(job.folder, folder), ec);
  for (const auto& file : look.files)
    AFTERGLOW_CHECK(pack_file(file, packed_place(job.folder, file).lexically_relative(job.folder).string(), job));
  return {};
}

Result<void> lock_packed_look(const BatchRequest& request, const std::vector<FrameJob>& frames, const fs::path& locked,
                              Job& job, Diagnostics& diagnostics) {
  AFTERGLOW_TRY(const Loaded look, load(request.preset, request.session.stack.preset, diagnostics));
  Preset& preset = *look.preset;
  AFTERGLOW_TRY(const Inventory inventory, inventory_of(preset, frames, request.loop, diagnostics));
  AFTERGLOW_TRY(const Lock lock, look_lock(preset, request.preset, inventory, request.pixel_options));
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
