// SPDX-License-Identifier: MIT
// Zips: what is unpacked lies inside of the cache and within the limits.
#include "core/pack.h"

#include <algorithm>
#include <cstdlib>

#include "core/paths.h"
#include "fuzz.h"

using namespace afterglow;
namespace fs = std::filesystem;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto zip = fuzz::write("p.zip", fuzz::text_of(data, size));
  const fs::path cache = fuzz::scratch() / "cache";
  PackLimits limits;
  limits.file_bytes = 1u << 20;
  limits.total_bytes = 2u << 20;
  limits.files = 64;
  const auto folder = open_zip(zip, cache, limits);
  std::error_code ec;
  std::uint64_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(fuzz::scratch())) {
    FUZZ_CLAIM(!entry.is_symlink(), entry.path().string());
    if (!entry.is_regular_file() || entry.path() == zip) continue;
    FUZZ_CLAIM(folder.ok() && entry.path().string().starts_with(folder->string() + "/"), entry.path().string());
    bytes += entry.file_size();
  }
  FUZZ_CLAIM(bytes <= limits.total_bytes, "");
  if (!folder) fuzz::check_error(folder.error(), {ErrorKind::script, ErrorKind::io});
  fs::remove_all(cache, ec);
  return 0;
}
