// SPDX-License-Identifier: MIT
#include "apps/driver_cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>

namespace afterglow {
namespace fs = std::filesystem;
namespace {

/// What Mesa maps: 65,536 keys of 20 bytes and a length; and some room for what it compiles.
constexpr off_t kIndexBytes = 65536 * 20 + 8, kRoom = 2 << 20;

/// Where Mesa keeps it; empty: nowhere.
fs::path mesa_folder() {
  for (const char* name : {"MESA_SHADER_CACHE_DIR", "MESA_GLSL_CACHE_DIR", "XDG_CACHE_HOME"})
    if (const char* folder = std::getenv(name); folder && *folder) return fs::path(folder) / "mesa_shader_cache";
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "mesa_shader_cache";
  return {};
}

enum class Room { none, taken, unknown };

/// Room for all of the file that Mesa maps, which has holes where nothing was written yet. Unknown: it is not there.
Room room_of_index(const fs::path& file) {
  struct stat status {};
  constexpr off_t kBlock = 512;  // of st_blocks, whatever the disk's are
  if (stat(file.c_str(), &status) != 0 || status.st_size < kIndexBytes) return Room::unknown;
  if (status.st_blocks * kBlock >= status.st_size) return Room::taken;
  const int index = open(file.c_str(), O_RDWR | O_CLOEXEC);
  if (index < 0) return Room::taken;  // Mesa cannot write to it either
  const bool full =
      fallocate(index, FALLOC_FL_KEEP_SIZE, 0, status.st_size) != 0 && (errno == ENOSPC || errno == EDQUOT);
  close(index);
  return full ? Room::none : Room::taken;
}

/// The nearest of a path that is there: the driver makes the folders below.
fs::path existing(fs::path path) {
  struct stat status {};
  while (path.has_relative_path() && lstat(path.c_str(), &status) != 0) path = path.parent_path();
  return path.empty() ? fs::path(".") : path;
}

/// Whether a file without a name gets its room there. Where such files cannot be made at all, the driver does without
/// its cache too, or knows what it does.
bool is_full(const fs::path& folder) {
  const int file = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file < 0) return errno == ENOSPC || errno == EDQUOT;
  const bool full = fallocate(file, 0, 0, kRoom) != 0 && (errno == ENOSPC || errno == EDQUOT);
  close(file);
  return full;
}

}  // namespace

std::optional<std::string> avoid_full_driver_cache() {
  const fs::path folder = mesa_folder();
  if (folder.empty() || std::getenv("MESA_SHADER_CACHE_DISABLE")) return std::nullopt;
  const fs::path place = existing(folder);
  std::error_code ignored;
  const bool usable = fs::is_directory(place, ignored) && access(place.c_str(), W_OK | X_OK) == 0;
  const Room room = room_of_index(folder / "index");
  if (usable && (room == Room::taken || (room == Room::unknown && !is_full(place)))) return std::nullopt;
  setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
  return fmt::format("{}: {}; the driver compiles shaders without its cache", folder.string(),
                     usable ? "the disk is full" : "cannot be written to");
}

}  // namespace afterglow
