// SPDX-License-Identifier: MIT
// Picture files of every format, header and pixels, within limits that leave no room for a bomb.
#include <fmt/format.h>

#include <cmath>

#include "fuzz.h"
#include "image/reader.h"

using namespace afterglow;

/// Modules take seconds to load under the sanitizers: not in the time of an input.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  Diagnostics silent;
  (void)read_picture(fuzz::write("tiny.pgm", "P2 1 1 1 1"), {}, silent);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = fuzz::write("picture", fuzz::text_of(data, size));
  ReadOptions options;
  options.auxiliary = {"depth", "normal", "motion"};
  options.max_side = 1024;
  options.max_bytes = 32u << 20;
  const auto header = read_header(file, options);
  if (!header) fuzz::check_error(header.error(), {ErrorKind::io});
  Diagnostics silent;
  const auto picture = read_picture(file, options, silent);
  if (!picture) {
    fuzz::check_error(picture.error(), {ErrorKind::io});
    return 0;
  }
  FUZZ_CLAIM(header.ok(), "");
  const Image& color = picture->color;
  FUZZ_CLAIM(color.width >= 1 && color.height >= 1 && color.width <= 1024 && color.height <= 1024, "");
  FUZZ_CLAIM(header->host_bytes <= options.max_bytes, fmt::format("{}", header->host_bytes));
  for (std::size_t i = 0; i < color.pixels.size(); ++i) {
    const bool alpha = i % 4 == 3;  // may have either sign
    FUZZ_CLAIM(std::isfinite(color.pixels[i]) && (alpha || color.pixels[i] >= 0),
               fmt::format("sample {}: {}", i, color.pixels[i]));
  }
  for (const auto& [name, image] : picture->auxiliary)
    for (const float v : image.pixels) FUZZ_CLAIM(std::isfinite(v), name);
  return 0;
}
