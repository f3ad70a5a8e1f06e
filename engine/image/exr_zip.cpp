// SPDX-License-Identifier: MIT
#include "image/exr_zip.h"

#include <libdeflate.h>

#include <new>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace afterglow {
namespace {

constexpr std::uint8_t kMiddle = 128;  // differences are stored around it

/// Each byte plus all before it.
void add_up(std::span<std::uint8_t> bytes) {
  std::size_t i = 1;
  std::uint8_t last = bytes.empty() ? std::uint8_t{0} : bytes[0];
#if defined(__SSE2__)
  const __m128i middle = _mm_set1_epi8(static_cast<char>(kMiddle));
  for (; i + 16 <= bytes.size(); i += 16) {
    auto* at = reinterpret_cast<__m128i*>(bytes.data() + i);
    __m128i sum = _mm_sub_epi8(_mm_loadu_si128(at), middle);
    sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 1));
    sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 2));
    sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 4));
    sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 8));
    sum = _mm_add_epi8(sum, _mm_set1_epi8(static_cast<char>(last)));
    _mm_storeu_si128(at, sum);
    last = bytes[i + 15];
  }
#endif
  for (; i < bytes.size(); ++i) {
    last = static_cast<std::uint8_t>(last + bytes[i] - kMiddle);
    bytes[i] = last;
  }
}

void put_together(std::span<const std::uint8_t> apart, std::span<std::uint8_t> bytes) {
  const std::size_t pairs = bytes.size() / 2;
  const std::uint8_t *even = apart.data(), *odd = apart.data() + (bytes.size() + 1) / 2;
  std::uint8_t* out = bytes.data();
  for (std::size_t i = 0; i < pairs; ++i) {
    out[2 * i] = even[i];
    out[2 * i + 1] = odd[i];
  }
  if (bytes.size() % 2 != 0) out[2 * pairs] = even[pairs];
}

void put_apart(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> apart) {
  const std::size_t pairs = bytes.size() / 2;
  std::uint8_t *even = apart.data(), *odd = apart.data() + (bytes.size() + 1) / 2;
  const std::uint8_t* from = bytes.data();
  for (std::size_t i = 0; i < pairs; ++i) {
    even[i] = from[2 * i];
    odd[i] = from[2 * i + 1];
  }
  if (bytes.size() % 2 != 0) even[pairs] = from[2 * pairs];
}

void take_differences(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> out) {
  const std::uint8_t* from = bytes.data();
  std::uint8_t* to = out.data();
  if (!bytes.empty()) to[0] = from[0];
  for (std::size_t i = 1; i < bytes.size(); ++i) to[i] = static_cast<std::uint8_t>(from[i] - from[i - 1] + kMiddle);
}

}  // namespace

ExrZip::ExrZip(int level) : deflate_(libdeflate_alloc_compressor(level)) {
  if (deflate_ == nullptr) throw std::bad_alloc();
}

ExrZip::~ExrZip() { libdeflate_free_compressor(deflate_); }

std::span<const std::uint8_t> ExrZip::differences(std::span<const std::uint8_t> bytes) {
  apart_.resize(bytes.size());
  differences_.resize(bytes.size());
  put_apart(bytes, apart_);
  take_differences(apart_, differences_);
  return differences_;
}

std::span<const std::uint8_t> ExrZip::run(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& packed) {
  const auto from = differences(bytes);
  packed.resize(bytes.size());  // what needs more is not taken
  packed.resize(libdeflate_zlib_compress(deflate_, from.data(), from.size(), packed.data(), packed.size()));
  if (packed.empty() || packed.size() >= bytes.size()) return bytes;
  return packed;
}

void ExrZip::append(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& packed) {
  append_plain(differences(bytes), packed);
}

void ExrZip::append_plain(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& packed) {
  const std::size_t at = packed.size(), room = libdeflate_zlib_compress_bound(deflate_, bytes.size());
  packed.resize(at + room);
  packed.resize(at + libdeflate_zlib_compress(deflate_, bytes.data(), bytes.size(), packed.data() + at, room));
}

ExrUnzip::ExrUnzip() : inflate_(libdeflate_alloc_decompressor()) {
  if (inflate_ == nullptr) throw std::bad_alloc();
}

ExrUnzip::~ExrUnzip() { libdeflate_free_decompressor(inflate_); }

bool ExrUnzip::run(std::span<const std::uint8_t> packed, std::span<std::uint8_t> bytes) {
  apart_.resize(bytes.size());
  const auto done = libdeflate_zlib_decompress(inflate_, packed.data(), packed.size(), apart_.data(), apart_.size(),
                                               nullptr);  // no length asked for: it must be exactly this
  if (done != LIBDEFLATE_SUCCESS) return false;
  add_up(apart_);
  put_together(apart_, bytes);
  return true;
}

}  // namespace afterglow
