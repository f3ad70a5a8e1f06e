// SPDX-License-Identifier: MIT
#include "core/module.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/module_shapes.h"
#include "core/own_file.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

std::vector<fs::path> candidates(const std::string& name) {
  std::vector<fs::path> folders;
  if (const fs::path own = own_file(); !own.empty()) {
    const fs::path folder = own.parent_path();
    folders.insert(folders.end(), {folder, folder / "afterglow", folder.parent_path() / AFTERGLOW_MODULE_FOLDER});
  }
  folders.emplace_back(is_in_build_folder() ? fs::path(AFTERGLOW_BUILT_MODULE_FOLDER)
                                            : fs::path(AFTERGLOW_PREFIX) / AFTERGLOW_MODULE_FOLDER);
  for (fs::path& folder : folders) folder /= name;
  return folders;
}

}  // namespace

Result<void*> load_module(const std::string& name, const char* entry) {
  std::string why = "not found";
  for (const fs::path& file : candidates(name)) {
    std::error_code ignored;
    if (!fs::exists(file, ignored)) continue;
    // Never closed: what they link keeps threads.
    void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) {
      why = dlerror();
      continue;
    }
    const auto shapes = reinterpret_cast<const char* (*)()>(dlsym(library, "afterglow_module_shapes"));
    if (!shapes || std::string_view(shapes()) != module_shapes()) {
      why = file.string() + " is of another build of Afterglow; was it updated? Start the program anew";
      continue;
    }
    if (void* address = dlsym(library, entry)) return address;
    why = fmt::format("{} lacks {}", file.string(), entry);
  }
  return Error{ErrorKind::io, fmt::format("{} ({})", name, why)};
}

}  // namespace afterglow
