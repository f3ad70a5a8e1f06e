// SPDX-License-Identifier: MIT
#include "core/inside.h"

#include <algorithm>
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

}  // namespace afterglow
