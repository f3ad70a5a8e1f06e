// SPDX-License-Identifier: MIT
#include "image/write_cineon.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "image/metadata.h"

namespace afterglow {
namespace {

constexpr std::uint32_t kGenericBytes = 1024, kFilmBytes = 1024, kUndefined = 0xffffffff;
constexpr float kLargestDensity = 2.046f;  // of code 1023, 0.002 a code

/// The fields of a header, one behind the other; big-endian.
class Fields {
 public:
  void byte(int value) { bytes_ += static_cast<char>(value); }
  void number(std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) byte(static_cast<int>(value >> shift & 255));
  }
  void real(float value) { number(std::bit_cast<std::uint32_t>(value)); }
  void undefined_reals(int count) {
    for (int i = 0; i < count; ++i) number(0x7f800000);  // infinity stands for "not known"
  }
  void text(std::string value, std::size_t size) {
    value.resize(size - 1);  // ends with a zero
    bytes_ += value + '\0';
  }
  void zeros(std::size_t count) { bytes_.append(count, '\0'); }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

std::string text_of(const Picture& picture, const char* name) {
  const MetadataValue* value = picture.facts ? find_metadata(picture.facts->metadata, name) : nullptr;
  return value ? metadata_text(*value) : std::string();
}

void add_channel(Fields& head, int colour, Size size) {
  head.byte(0);
  head.byte(colour);  // 1 red, 2 green, 3 blue: printing density
  head.byte(10);
  head.byte(0);
  head.number(static_cast<std::uint32_t>(size.width));
  head.number(static_cast<std::uint32_t>(size.height));
  head.real(0);
  head.real(0);
  head.real(1023);
  head.real(kLargestDensity);
}

std::string header_of(const Picture& picture, Size size) {
  const std::string time = text_of(picture, "DateTime");  // YYYY:MM:DD hh:mm:ss
  const std::string day = time.substr(0, std::min<std::size_t>(10, time.size()));
  const std::string hour = time.size() > 11 ? time.substr(11) : std::string();
  Fields head;
  head.number(0x802a5fd7);
  head.number(kGenericBytes + kFilmBytes);
  head.number(kGenericBytes);
  head.number(kFilmBytes);
  head.number(0);  // no user's data
  head.number(static_cast<std::uint32_t>(kGenericBytes + kFilmBytes + size.area() * 4));
  head.text("V4.5", 8);
  head.text(picture.facts ? picture.facts->file.filename().string() : std::string(), 100);
  head.text(day, 12);
  head.text(hour, 12);
  head.zeros(36);
  head.byte(0);  // left to right, top to bottom
  head.byte(3);
  head.zeros(2);
  for (int colour = 1; colour <= 3; ++colour) add_channel(head, colour, size);
  head.zeros(5 * 28);       // five more channels
  head.undefined_reals(8);  // white point and primaries
  head.text(text_of(picture, "ImageDescription"), 200);
  head.zeros(28);
  head.byte(0);  // pixel by pixel
  head.byte(5);  // three samples in 32 bits, to the left
  head.zeros(2 + 4 + 4 + 20);
  head.number(0);  // origin
  head.number(0);
  head.zeros(100 + 12 + 12);
  head.text(text_of(picture, "Model"), 64);
  head.zeros(32 + 32);
  head.undefined_reals(3);  // pitch, gamma
  head.zeros(40);
  for (int i = 0; i < 4; ++i) head.byte(255);  // film's maker and type
  head.number(kUndefined);
  head.number(kUndefined);
  head.zeros(32);
  head.number(kUndefined);
  head.undefined_reals(1);
  head.zeros(32 + 200 + 740);
  return head.bytes();
}

}  // namespace

Result<void> write_cineon(const Picture& picture, const StripForm& form, OutputFile& out) {
  const Size size = picture.display_window.size();
  const std::string header = header_of(picture, size);
  out.write(header.data(), header.size());
  constexpr int kRows = 64;
  const auto width = static_cast<std::size_t>(size.width);
  std::vector<std::uint8_t> strip(form.row_bytes(picture) * kRows);
  std::vector<std::uint32_t> packed(width * kRows);
  for (int y = 0; y < size.height && !out.failure(); y += kRows) {
    const int rows = std::min(kRows, size.height - y);
    encode_strip(picture, form, y, rows, strip.data());
    const auto pixels = width * static_cast<std::size_t>(rows);
    for (std::size_t i = 0; i < pixels; ++i) {
      std::uint16_t code[3];
      std::memcpy(code, &strip[i * sizeof(code)], sizeof(code));
      packed[i] = __builtin_bswap32(std::uint32_t{code[0]} << 22 | std::uint32_t{code[1]} << 12 | code[2] << 2);
    }
    out.write(packed.data(), pixels * sizeof(std::uint32_t));
  }
  return {};
}

}  // namespace afterglow
