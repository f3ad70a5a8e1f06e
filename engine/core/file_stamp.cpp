// SPDX-License-Identifier: MIT
#include "core/file_stamp.h"

#include <fmt/format.h>
#include <sys/stat.h>

namespace afterglow {

std::string file_stamp(const std::filesystem::path& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) return {};
  return fmt::format("{} {}.{:09}", status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec);
}

}  // namespace afterglow
