// SPDX-License-Identifier: MIT
// Look-up tables: the first line is the extension, the rest the file.
#include <cmath>

#include "fuzz.h"
#include "image/lut_file.h"

using namespace afterglow;

/// Modules take seconds to load under the sanitizers: not in the time of an input.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  (void)read_lut(fuzz::write("tiny.cube", "LUT_1D_SIZE 2\n0 0 0\n1 1 1\n"));
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input = fuzz::text_of(data, size);
  const std::size_t line = input.find('\n');
  if (line == std::string_view::npos || line == 0 || line > 12) return 0;
  for (const char c : input.substr(0, line))
    if (!((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))) return 0;
  const auto file = fuzz::write("table." + std::string(input.substr(0, line)), input.substr(line + 1));
  const auto lut = read_lut(file);
  std::error_code ec;
  std::filesystem::remove(file, ec);
  if (!lut) {
    fuzz::check_error(lut.error(), {ErrorKind::script, ErrorKind::io});
    return 0;
  }
  FUZZ_CLAIM(!lut->steps.empty() || lut->size.width >= 1, "");
  FUZZ_CLAIM(lut->steps.size() <= kMaxLutSteps, "");
  FUZZ_CLAIM(lut->table.size() == static_cast<std::size_t>(lut->size.area()) * 4, "");
  for (const float v : lut->table) FUZZ_CLAIM(std::isfinite(v), "");
  return 0;
}
