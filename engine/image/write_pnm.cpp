// SPDX-License-Identifier: MIT
#include "image/write_pnm.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string>
#include <vector>

namespace afterglow {
namespace {

static_assert(std::endian::native == std::endian::little);

std::string pnm_header(OutputKind kind, Size size, const StripForm& form) {
  const auto [width, height] = size;
  if (kind == OutputKind::pfm) return fmt::format("PF\n{} {}\n-1.0\n", width, height);
  const int most = max_code(form.type);
  if (kind == OutputKind::ppm) return fmt::format("P6\n{} {}\n{}\n", width, height, most);
  return fmt::format("P7\nWIDTH {}\nHEIGHT {}\nDEPTH {}\nMAXVAL {}\nTUPLTYPE {}\nENDHDR\n", width, height,
                     form.alpha ? 4 : 3, most, form.alpha ? "RGB_ALPHA" : "RGB");
}

}  // namespace

Result<void> write_pnm(const Picture& picture, OutputKind kind, const StripForm& form, OutputFile& out) {
  const Size size = picture.display_window.size();
  const std::string header = pnm_header(kind, size, form);
  out.write(header.data(), header.size());
  constexpr int kRows = 64;
  const std::size_t row_bytes = form.row_bytes(picture);
  std::vector<std::uint8_t> strip(row_bytes * kRows);
  for (int done = 0; done < size.height && !out.failure(); done += kRows) {
    const int rows = std::min(kRows, size.height - done);
    const bool upwards = kind == OutputKind::pfm;
    encode_strip(picture, form, upwards ? size.height - done - rows : done, rows, strip.data());
    if (form.type == SampleType::uint16)
      for (std::size_t i = 0; i + 1 < row_bytes * static_cast<std::size_t>(rows); i += 2)
        std::swap(strip[i], strip[i + 1]);
    for (int i = 0; i < rows; ++i)
      out.write(strip.data() + row_bytes * static_cast<std::size_t>(upwards ? rows - 1 - i : i), row_bytes);
  }
  return {};
}

}  // namespace afterglow
