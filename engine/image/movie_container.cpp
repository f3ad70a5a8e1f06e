// SPDX-License-Identifier: MIT
#include "image/movie_container.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <system_error>

#include "image/container_bytes.h"
#include "image/file_signature.h"
#include "image/still_brands.h"

namespace afterglow {
namespace {

using namespace std::string_view_literals;

constexpr std::array kMovieSignatures{
    FileSignature{4, "ftyp"sv, "mov"},
    FileSignature{4, "moov"sv, "mov"},
    FileSignature{4, "mdat"sv, "mov"},
    FileSignature{4, "wide"sv, "mov"},
    FileSignature{8, "AVI "sv, "avi"},
    FileSignature{0, "\x1a\x45\xdf\xa3"sv, "matroska"},
    FileSignature{0, "\0\0\1\xba"sv, "mpeg"},
    FileSignature{0, "\0\0\1\xb3"sv, "mpegvideo"},
    FileSignature{0, "OggS"sv, "ogg"},
    FileSignature{0, "FLV\1"sv, "flv"},
    FileSignature{0, "\x30\x26\xb2\x75\x8e\x66\xcf\x11"sv, "asf"},
    FileSignature{0, "\x06\x0e\x2b\x34\x02\x05\x01\x01"sv, "mxf"},
    FileSignature{0, "DKIF"sv, "ivf"},
    FileSignature{0, "nut/multimedia container\0"sv, "nut"},
    FileSignature{0, "YUV4MPEG2"sv, "yuv4mpegpipe"},
};

/// Transport streams have no name, but a mark at the start of every packet; those of Blu-ray discs four bytes further.
bool is_transport_stream(std::string_view head) {
  for (const auto& [first, step] : {std::pair{0u, 188u}, std::pair{4u, 192u}})
    if (head.size() > first + 2 * step && head[first] == 'G' && head[first + step] == 'G' &&
        head[first + 2 * step] == 'G')
      return true;
  return false;
}

/// Reads bytes that may not be there.
class ByteReader {
 public:
  explicit ByteReader(std::ifstream& in) : in_(in) {}
  int byte() { return in_.get(); }  ///< −1 at the end
  void skip(std::streamoff count) { in_.seekg(count, std::ios::cur); }
  std::uint32_t big() {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint32_t>(in_.get() & 255);
    return value;
  }
  explicit operator bool() const { return static_cast<bool>(in_); }

 private:
  std::ifstream& in_;
};

int color_table_bytes(int flags) { return (flags & 0x80) != 0 ? 3 << ((flags & 7) + 1) : 0; }

/// GIF89a, 20 to 26: more than one image descriptor.
bool gif_moves(std::ifstream& in) {
  constexpr int kImage = 0x2c, kExtension = 0x21;
  in.seekg(10);
  ByteReader bytes(in);
  const int flags = bytes.byte();
  bytes.skip(2 + color_table_bytes(flags));
  int images = 0;
  while (bytes) {
    const int kind = bytes.byte();
    if (kind == kImage) {
      if (++images == 2) return true;
      bytes.skip(8);
      bytes.skip(color_table_bytes(bytes.byte()) + 1);
    } else if (kind == kExtension) {
      bytes.skip(1);
    } else {
      return false;
    }
    for (int size = bytes.byte(); size > 0; size = bytes.byte()) bytes.skip(size);
  }
  return false;
}

/// An animation control chunk of more than one frame before the first pixels.
bool png_moves(std::ifstream& in) {
  in.seekg(8);
  ByteReader bytes(in);
  while (bytes) {
    const std::uint32_t size = bytes.big(), kind = bytes.big();
    if (!bytes || kind == 0x49444154) return false;  // IDAT
    if (kind == 0x6163544c) return bytes.big() > 1;  // acTL
    bytes.skip(static_cast<std::streamoff>(size) + 4);
  }
  return false;
}

}  // namespace

std::string movie_format(const std::filesystem::path& file) {
  std::error_code ec;
  if (!std::filesystem::is_regular_file(file, ec)) return "";  // a pipe would be waited for
  std::array<char, 400> bytes{};
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), bytes.size());
  const std::string_view head(bytes.data(), static_cast<std::size_t>(in.gcount()));
  in.clear();
  if (const auto format = format_by_signature(kMovieSignatures, head); !format.empty()) {
    return still_of(head) != Still::none ? "" : std::string(format);
  }
  if (head.starts_with("GIF8"sv)) return gif_moves(in) ? "gif" : "";
  if (head.starts_with("\x89PNG"sv)) return png_moves(in) ? "apng" : "";
  constexpr std::size_t kWebpFlags = 20;
  constexpr int kAnimation = 2;
  if (head.size() > kWebpFlags && head.substr(8).starts_with("WEBPVP8X"sv) && (head[kWebpFlags] & kAnimation) != 0)
    return "webp";
  return is_transport_stream(head) ? "mpegts" : "";
}

}  // namespace afterglow
