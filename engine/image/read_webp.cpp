// SPDX-License-Identifier: MIT
#include "image/read_webp.h"

#include <webp/decode.h>

#include "core/file.h"

namespace afterglow {

Result<std::vector<std::uint8_t>> read_webp(const std::filesystem::path& file, const Size& size) {
  constexpr std::size_t kMost = std::size_t{4} << 30;  // that the form can hold
  const auto damaged = [&] { return Error{ErrorKind::io, "cannot be read: it is damaged or cut off", file.string()}; };
  AFTERGLOW_TRY(const std::string bytes, read_file(file, kMost));
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  Size stored;
  if (WebPGetInfo(data, bytes.size(), &stored.width, &stored.height) == 0 || stored != size) return damaged();
  const std::size_t row = static_cast<std::size_t>(size.width) * 4;
  std::vector<std::uint8_t> codes(row * static_cast<std::size_t>(size.height));
  if (!WebPDecodeRGBAInto(data, bytes.size(), codes.data(), codes.size(), static_cast<int>(row))) return damaged();
  return codes;
}

}  // namespace afterglow
