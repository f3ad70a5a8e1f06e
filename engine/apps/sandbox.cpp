// SPDX-License-Identifier: MIT
#include "apps/sandbox.h"

#include <cstdlib>

#include "core/own_file.h"
#include "core/paths.h"
#include "core/temporary.h"
#include "core/text.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

/// Those of GPUs, and those that are nobody's: no terminals, disks, cameras, shared memory of others.
void add_devices(Confinement& left) {
  for (const char* name : {"null", "zero", "full", "random", "urandom", "dri", "udmabuf", "dma_heap", "dxg"})
    left.devices.push_back(fs::path("/dev") / name);
  left.list.emplace_back("/dev");
  std::error_code ec;
  for (fs::directory_iterator it("/dev", ec), end; !ec && it != end; it.increment(ec)) {
    const std::string name = it->path().filename().string();
    for (const char* begin : {"nvidia", "nvhost", "nvmap", "mali", "kgsl", "pvr"})
      if (name.starts_with(begin)) left.devices.push_back(it->path());
  }
}

/// What libraries and drivers need that every program on the machine may read.
void add_system(Confinement& left) {
  left.execute.insert(left.execute.end(), {"/usr", "/lib", "/lib64", "/bin", "/opt"});
  for (const char* file : {"/etc/ld.so.cache", "/etc/vulkan", "/etc/glvnd", "/etc/drirc", "/etc/localtime",
                           "/etc/nvidia", "/etc/alternatives", "/proc", "/sys"})
    left.read.emplace_back(file);
  add_devices(left);
  const fs::path own = own_file();
  if (!own.empty()) left.execute.insert(left.execute.end(), {folder_of(own), folder_of(folder_of(own)) / "lib"});
  // Layers and drivers that someone has chosen by the environment.
  for (const char* name :
       {"VK_ICD_FILENAMES", "VK_DRIVER_FILES", "VK_ADD_LAYER_PATH", "VK_LAYER_PATH", "LD_LIBRARY_PATH"})
    if (const char* value = std::getenv(name))
      for (const std::string& path : split(value, ':'))
        if (!path.empty()) left.execute.push_back(fs::is_directory(path) ? fs::path(path) : folder_of(path));
  left.read.push_back(cache_folder());
  if (const char* mesa = std::getenv("MESA_SHADER_CACHE_DIR")) left.read.emplace_back(mesa);
  if (const char* cache = std::getenv("XDG_CACHE_HOME"))
    left.read.push_back(fs::path(cache) / "mesa_shader_cache");
  else if (const char* home = std::getenv("HOME"))
    left.read.push_back(fs::path(home) / ".cache" / "mesa_shader_cache");
}

/// Files become others in their folder when they are whole; devices and pipes are written to as they stand.
void add_output(Confinement& left, const fs::path& output) {
  if (output.empty() || output == "-") return;
  const fs::path target = behind_links(output);
  std::error_code ignored;
  const auto status = fs::status(output, ignored);
  const bool stands = fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
  if (stands || output.string().starts_with("/dev/"))
    left.devices.push_back(output);
  else
    left.write.push_back(fs::is_directory(status) ? output : folder_of(target));
}

}  // namespace

Result<Confinement> sandbox_of(const RunArguments& a) {
  Confinement left;
  add_system(left);
  AFTERGLOW_TRY(const fs::path preset, a.preset.preset_file());
  const std::vector<fs::path> extra(a.preset.paths.begin(), a.preset.paths.end());
  const SearchPath search = search_path_for(preset, extra);
  left.read.insert(left.read.end(), search.user.begin(), search.user.end());
  left.read.insert(left.read.end(), {folder_of(preset), search.installation});
  if (const char* ocio = std::getenv("OCIO")) left.read.push_back(folder_of(ocio));
  if (!a.execution.calibration.empty()) left.read.emplace_back(a.execution.calibration);
  if (!a.locked.empty()) left.read.emplace_back(a.locked);
  // A picture is read alone; of a sequence the folder, whose other files are its frames.
  const auto picture = [&left](const std::string& given) {
    std::error_code ignored;
    if (given.empty() || given == "-") return;
    left.list.push_back(folder_of(given));
    left.read.push_back(fs::exists(given, ignored) ? fs::path(given) : folder_of(given));
  };
  for (const auto& input : a.files.inputs) picture(input);
  if (!a.layers.mattes.empty()) picture(a.layers.mattes);
  if (!a.audio.empty()) left.read.emplace_back(a.audio);
  for (const auto* layer : {&a.layers.depth, &a.layers.normal, &a.layers.motion})
    if (const LayerChoice choice = parse_layer_choice(*layer); !choice.file.empty()) picture(choice.file.string());
  for (const auto& output : {a.files.output, a.report, a.lock}) add_output(left, output);
  return left;
}

}  // namespace afterglow
