// SPDX-License-Identifier: MIT
// PNG files byte by byte: what OpenImageIO does not write.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <vector>

namespace afterglow {

class RawPng {
 public:
  RawPng(int width, int height, int bits, int type, bool interlaced = false) : bytes_("\x89PNG\r\n\x1a\n", 8) {
    std::string head;
    for (const int side : {width, height}) head += big_endian(static_cast<std::uint32_t>(side));
    head += {static_cast<char>(bits), static_cast<char>(type), 0, 0, static_cast<char>(interlaced)};
    chunk("IHDR", head);
  }
  static std::string big_endian(std::uint32_t v) {
    return {static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8), static_cast<char>(v)};
  }
  RawPng& chunk(const std::string& type, const std::string& data) {
    const std::string body = type + data;
    bytes_ += big_endian(static_cast<std::uint32_t>(data.size())) + body + big_endian(crc(body));
    return *this;
  }
  /// Pixel rows without their filter bytes, all of them at once, in one stored deflate block.
  RawPng& pixels(const std::vector<std::string>& rows) {
    std::string raw;
    for (const std::string& row : rows) raw += std::string(1, '\0') + row;
    const auto size = static_cast<std::uint16_t>(raw.size());
    std::uint32_t a = 1, b = 0;
    for (const unsigned char c : raw) {
      a = (a + c) % 65521;
      b = (b + a) % 65521;
    }
    const auto word = [](std::uint16_t v) { return std::string{static_cast<char>(v), static_cast<char>(v >> 8)}; };
    return chunk("IDAT", std::string("\x78\x01\x01", 3) + word(size) + word(static_cast<std::uint16_t>(~size)) + raw +
                             big_endian(b << 16 | a));
  }
  std::string finish() { return chunk("IEND", "").bytes_; }

 private:
  static std::uint32_t crc(const std::string& data) {
    std::uint32_t c = ~0u;
    for (const unsigned char byte : data) {
      c ^= byte;
      for (int i = 0; i < 8; ++i) c = c >> 1 ^ (c & 1 ? 0xedb88320u : 0);
    }
    return ~c;
  }
  std::string bytes_;
};

/// As zlib packs it, at its best.
inline std::string deflated(const std::string& data) {
  uLongf size = compressBound(static_cast<uLong>(data.size()));
  std::string out(size, '\0');
  compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(data.data()),
            static_cast<uLong>(data.size()), 9);
  out.resize(size);
  return out;
}

}  // namespace afterglow
