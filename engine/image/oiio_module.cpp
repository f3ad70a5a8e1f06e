#include "image/oiio_module.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <vector>

namespace afterglow {
namespace fs = std::filesystem;
namespace {

constexpr const char* kName = "afterglow_oiio.so";
constexpr const char* kEntry = "afterglow_oiio_module";

/// Beside the binary that holds this code, in the library folder of its installation, where it was built.
std::vector<fs::path> candidates() {
  std::vector<fs::path> folders;
  Dl_info here{};
  if (dladdr(reinterpret_cast<const void*>(&oiio_module), &here) && here.dli_fname) {
    std::error_code ec;
    fs::path binary = fs::canonical(here.dli_fname, ec);
    if (ec) binary = fs::read_symlink("/proc/self/exe", ec);
    folders.push_back(binary.parent_path());
    folders.push_back(binary.parent_path() / "afterglow");
    folders.push_back(binary.parent_path().parent_path() / AFTERGLOW_MODULE_FOLDER);
  }
  folders.emplace_back(AFTERGLOW_BUILT_MODULE_FOLDER);
  for (fs::path& folder : folders) folder /= kName;
  return folders;
}

Result<const OiioModule*> load() {
  std::string why = "not found";
  for (const fs::path& file : candidates()) {
    std::error_code ignored;
    if (!fs::exists(file, ignored)) continue;
    // Never closed: OpenImageIO keeps threads.
    void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) {
      why = dlerror();
      continue;
    }
    using Entry = const OiioModule* (*)();
    if (const auto entry = reinterpret_cast<Entry>(dlsym(library, kEntry))) return entry();
    why = fmt::format("{} lacks {}", file.string(), kEntry);
  }
  return Error{ErrorKind::io, fmt::format("cannot be read or written: {} ({})", kName, why)};
}

}  // namespace

Result<const OiioModule*> oiio_module() {
  static const Result<const OiioModule*> module = load();
  return module;
}

}  // namespace afterglow
