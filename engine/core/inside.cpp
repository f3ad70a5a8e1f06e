// SPDX-License-Identifier: MIT
#include "core/inside.h"

#include <algorithm>
#include <iterator>
#include <system_error>

namespace afterglow {
namespace fs = std::filesystem;

bool lies_in(const fs::path& file, const fs::path& folder) {
  std::error_code ec;
  const fs::path real_file = fs::weakly_canonical(file, ec);
  if (ec) return false;
  const fs::path real_folder = fs::canonical(folder.empty() ? fs::path(".") : folder, ec);
  if (ec) return false;
  const auto [end, ignored] = std::mismatch(real_folder.begin(), real_folder.end(), real_file.begin(), real_file.end());
  return end == real_folder.end();
}

bool is_named_in(const fs::path& file, const fs::path& folder) {
  const fs::path rest = file.lexically_normal().lexically_relative((folder / "").lexically_normal());
  return !rest.empty() && *rest.begin() != "..";
}

std::vector<fs::path> own_first(std::vector<fs::path> folders, const fs::path& file) {
  const auto depth = [](const fs::path& folder) {
    const fs::path normal = folder.lexically_normal();
    return std::distance(normal.begin(), normal.end());
  };
  const auto others = std::stable_partition(folders.begin(), folders.end(),
                                            [&](const fs::path& folder) { return is_named_in(file, folder); });
  std::stable_sort(folders.begin(), others, [&](const fs::path& a, const fs::path& b) { return depth(a) > depth(b); });
  return folders;
}

fs::path whole_path(const fs::path& path) {
  std::error_code ec;
  fs::path out = fs::absolute(path, ec);
  const auto is_up = [](const fs::path& part) { return part == ".."; };
  if (is_up(out.filename()))
    out = fs::weakly_canonical(out, ec);
  else if (std::ranges::any_of(out, is_up))
    out = fs::weakly_canonical(out.parent_path(), ec) / out.filename();
  out = out.lexically_normal();
  return out.has_filename() ? out : out.parent_path();
}

}  // namespace afterglow
