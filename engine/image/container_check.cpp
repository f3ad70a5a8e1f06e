// SPDX-License-Identifier: MIT
#include "image/container_check.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/file.h"
#include "core/saturated.h"
#include "image/claimed_size.h"
#include "image/container_bytes.h"
#include "image/exr_header.h"
#include "image/film_check.h"
#include "image/heif_size.h"
#include "image/jpeg2000_check.h"
#include "image/jpeg_check.h"
#include "image/numbered_check.h"
#include "image/picture_format.h"
#include "image/sgi_check.h"
#include "image/tagged_check.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kPngChunks = 8;  ///< where they begin

/// The checksum of chunk type and data. Told here, damage is one error of ours; libpng would print its own line
/// besides.
Result<void> check_sum(const fs::path& file, std::ifstream& in, std::uint64_t at, std::uint64_t length) {
  std::vector<unsigned char> buffer(std::min<std::uint64_t>(length + 4, 1 << 18));
  in.seekg(static_cast<std::streamoff>(at + 4));
  uLong sum = crc32(0, nullptr, 0);
  for (std::uint64_t left = length + 4; left > 0;) {
    const std::size_t count = std::min<std::uint64_t>(left, buffer.size());
    if (!fill(in, buffer.data(), count)) return malformed(file, "is truncated");
    sum = crc32(sum, buffer.data(), static_cast<uInt>(count));
    left -= count;
  }
  std::array<unsigned char, 4> stored{};
  if (!fill(in, stored.data(), stored.size())) return malformed(file, "is truncated");
  if (big_endian(stored.data(), 4) != sum) return malformed(file, "is damaged: a checksum is wrong");
  return {};
}

/// Walks the chunks up to IEND.
Result<ContainerFacts> check_png(const fs::path& file, std::ifstream& in, std::uint64_t size) {
  ContainerFacts facts;
  facts.kind = ContainerFacts::Kind::png;
  std::uint64_t at = kPngChunks;
  while (true) {
    std::array<unsigned char, 8> head{};
    in.seekg(static_cast<std::streamoff>(at));
    if (!fill(in, head.data(), head.size())) return malformed(file, "is truncated");
    const std::uint64_t length = big_endian(head.data(), 4);
    const std::string type(reinterpret_cast<const char*>(&head[4]), 4);
    if (at + 12 + length > size) return malformed(file, "is truncated");
    std::array<unsigned char, 32> data{};
    if (length >= 4 && length <= data.size() && !fill(in, data.data(), length)) return malformed(file, "is truncated");
    const auto number = [&](int index) { return big_endian(&data[static_cast<std::size_t>(index) * 4], 4); };
    if (at == kPngChunks) {
      if (type != "IHDR" || length != 13) return malformed(file, "is a malformed PNG");
      if (number(0) < 1 || number(1) < 1) return malformed(file, "has no pixels");
      if (number(0) > 0x7fffffff || number(1) > 0x7fffffff) return malformed(file, "is a malformed PNG");
      facts.size = Size{static_cast<int>(number(0)), static_cast<int>(number(1))};
      const auto area = static_cast<std::uint64_t>(facts.size->area());
      facts.least_file_bytes = area / 8 / 1100;  // a bit a pixel at least, and deflate gains 1032 at most
      const bool interlaced = data[12] != 0, deep = data[8] == 16;
      if (interlaced) facts.decoder_bytes = saturated_product({area, 4, deep ? 2u : 1u});
    } else if (type == "sRGB") {
      facts.srgb = true;
    } else if (type == "cICP" && length == 4) {
      facts.codes = {data[0], data[1], data[3] == 0};
    } else if (type == "gAMA" && length == 4 && number(0) > 0) {
      facts.gamma = number(0) / 1e5;
    } else if (type == "cHRM" && length == 32) {
      const auto xy = [&](int i) { return std::array<double, 2>{number(2 * i) / 1e5, number(2 * i + 1) / 1e5}; };
      facts.primaries = Chromaticities{xy(1), xy(2), xy(3), xy(0)};
    }
    AFTERGLOW_CHECK(check_sum(file, in, at, length));
    if (const char* why = png_metadata_fault(type, in, at + 8, length, facts)) return malformed(file, why);
    if (type == "IEND") return facts;
    at += 12 + length;
  }
}

/// From a Radiance header the product of all EXPOSURE lines, and the order of columns. Errors: io (it holds XYZ, which
/// OpenImageIO does not know).
Result<void> read_radiance_header(const fs::path& file, std::span<const unsigned char> head, ContainerFacts& facts) {
  double product = 1;
  std::istringstream lines(std::string(head.begin(), head.end()));
  std::string line;
  while (std::getline(lines, line) && !line.empty()) {
    if (line.starts_with("FORMAT=32-bit_rle_xyze"))
      return malformed(file, "holds CIE XYZ (32-bit_rle_xyze), which is not read; write it as 32-bit_rle_rgbe");
    if (!line.starts_with("EXPOSURE=")) continue;
    const double exposure = std::strtod(line.c_str() + 9, nullptr);
    if (std::isfinite(exposure) && exposure > 0) product *= exposure;
  }
  if (product > 1e-30 && product < 1e30) facts.exposure = product;
  // "+X 4 +Y 3": columns from left to right, each upwards. OpenImageIO 2.4 takes it and "-X 4 -Y 3" for each other.
  std::string columns, rows;
  int width = 0, height = 0;
  if (lines >> columns >> width >> rows >> height) {
    if (columns == "-X" && rows == "-Y") facts.orientation = 6;
    if (columns == "+X" && rows == "+Y") facts.orientation = 8;
  }
  return {};
}

}  // namespace

Result<ContainerFacts> check_container(const fs::path& file) {
  std::error_code ec;
  const fs::file_status status = fs::status(file, ec);
  if (!fs::exists(status)) {
    if (!ec || ec == std::errc::no_such_file_or_directory) return missing_file(file);
    return Error{ErrorKind::io, "cannot be read: " + ec.message(), file.string()};
  }
  if (fs::is_directory(status)) return malformed(file, "is a folder, not a picture");
  if (!fs::is_regular_file(status)) return malformed(file, "is not a regular file");
  const std::uint64_t size = fs::file_size(file, ec);
  if (ec) return Error{ErrorKind::io, "cannot be read: " + ec.message(), file.string()};
  if (size == 0) return malformed(file, "is empty");
  std::ifstream in(file, std::ios::binary);
  if (!in) return Error{ErrorKind::io, fmt::format("cannot be read: {}", std::strerror(errno)), file.string()};
  std::array<unsigned char, 4096> bytes{};
  in.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
  const auto head = std::span<const unsigned char>(bytes).first(static_cast<std::size_t>(in.gcount()));
  in.clear();
  const std::string format = picture_format(file);
  if (format == "png") return check_png(file, in, size);
  if (format == "jpeg") return check_jpeg(file, in, size);
  ContainerFacts facts;
  if (is_exr(file)) facts.kind = ContainerFacts::Kind::exr;
  std::optional<ClaimedSize> claimed = claimed_size(head);
  if (format == "dpx") {
    AFTERGLOW_TRY(facts.line_padding, check_dpx(file, in, size));
    if (facts.line_padding > 0) facts.decoder_bytes = size;  // it is read with another header
  }
  if (format == "cineon") AFTERGLOW_CHECK(check_cineon(file, in, size));
  if (format == "sgi") AFTERGLOW_CHECK(check_sgi(file, in, size));
  if (format == "gif") AFTERGLOW_CHECK(check_gif(file, in, size));
  if (format == "webp") {
    AFTERGLOW_CHECK(check_webp(file, in, size, facts));
  }
  if (format == "tiff") AFTERGLOW_CHECK(check_tiff(file, in, size));
  if (format == "targa") {
    AFTERGLOW_TRY(claimed, check_targa(file, in, size));
    facts.fourth_is_padding = pads_targa(in, size);
  }
  if (format == "bmp") {
    AFTERGLOW_TRY(claimed, check_bmp(file, in));
    facts.fourth_is_padding = pads_bmp(in, size);
  }
  if (format == "pnm") {
    AFTERGLOW_TRY(facts.deep_pnm, deep_pnm(file, in, size));
    if (facts.deep_pnm)
      claimed = ClaimedSize{facts.deep_pnm->size, sizeof(float) * static_cast<unsigned>(facts.deep_pnm->channels)};
  }
  if (format == "heif") claimed = heif_size(in, size);
  if (format == "hdr") {
    AFTERGLOW_CHECK(read_radiance_header(file, head, facts));
  }
  if (format == "jpeg2000") {
    AFTERGLOW_TRY(claimed, check_jpeg2000(file, in, size));
  }
  if (claimed) {
    facts.size = claimed->size;
    facts.decoder_bytes =
        saturated_product({static_cast<std::uint64_t>(claimed->size.area()), claimed->bytes_per_pixel});
  }
  return facts;
}

}  // namespace afterglow
