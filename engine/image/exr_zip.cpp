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

#if defined(__SSE2__)
__m128i load_bytes(const std::uint8_t* from) { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from)); }
void store_bytes(std::uint8_t* to, __m128i bytes) { _mm_storeu_si128(reinterpret_cast<__m128i*>(to), bytes); }

/// Its last byte in all of them.
__m128i last_everywhere(__m128i bytes) {
  const __m128i pairs = _mm_unpackhi_epi8(bytes, bytes);
  return _mm_shuffle_epi32(_mm_shufflehi_epi16(pairs, 0xff), 0xff);
}
#endif

/// Each byte plus all before it.
void add_up(std::span<std::uint8_t> bytes) {
  if (bytes.empty()) return;
  std::size_t i = 1;
#if defined(__SSE2__)
  // Sums within 16 bytes wait for nothing; only their totals are added one after the other.
  const __m128i middle = _mm_set1_epi8(static_cast<char>(kMiddle));
  __m128i before = _mm_set1_epi8(static_cast<char>(bytes[0]));
  for (; i + 16 <= bytes.size(); i += 16) {
    __m128i sum = _mm_sub_epi8(load_bytes(&bytes[i]), middle);
    sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 1));
    sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 2));
    sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 4));
    sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 8));
    store_bytes(&bytes[i], _mm_add_epi8(sum, before));
    before = _mm_add_epi8(before, last_everywhere(sum));
  }
#endif
  for (; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(bytes[i - 1] + bytes[i] - kMiddle);
}

void put_together(std::span<const std::uint8_t> apart, std::span<std::uint8_t> bytes) {
  const std::size_t pairs = bytes.size() / 2;
  const std::uint8_t *even = apart.data(), *odd = apart.data() + (bytes.size() + 1) / 2;
  std::uint8_t* out = bytes.data();
  std::size_t i = 0;
#if defined(__SSE2__)
  for (; i + 16 <= pairs; i += 16) {
    const __m128i a = load_bytes(even + i), b = load_bytes(odd + i);
    store_bytes(out + 2 * i, _mm_unpacklo_epi8(a, b));
    store_bytes(out + 2 * i + 16, _mm_unpackhi_epi8(a, b));
  }
#endif
  for (; i < pairs; ++i) {
    out[2 * i] = even[i];
    out[2 * i + 1] = odd[i];
  }
  if (bytes.size() % 2 != 0) out[2 * pairs] = even[pairs];
}

void put_apart(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> apart) {
  const std::size_t pairs = bytes.size() / 2;
  std::uint8_t *even = apart.data(), *odd = apart.data() + (bytes.size() + 1) / 2;
  const std::uint8_t* from = bytes.data();
  std::size_t i = 0;
#if defined(__SSE2__)
  const __m128i low = _mm_set1_epi16(0xff);
  for (; i + 16 <= pairs; i += 16) {
    const __m128i a = load_bytes(from + 2 * i), b = load_bytes(from + 2 * i + 16);
    store_bytes(even + i, _mm_packus_epi16(_mm_and_si128(a, low), _mm_and_si128(b, low)));
    store_bytes(odd + i, _mm_packus_epi16(_mm_srli_epi16(a, 8), _mm_srli_epi16(b, 8)));
  }
#endif
  for (; i < pairs; ++i) {
    even[i] = from[2 * i];
    odd[i] = from[2 * i + 1];
  }
  if (bytes.size() % 2 != 0) even[pairs] = from[2 * pairs];
}

void take_differences(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> out) {
  const std::uint8_t* from = bytes.data();
  std::uint8_t* to = out.data();
  if (!bytes.empty()) to[0] = from[0];
  std::size_t i = 1;
#if defined(__SSE2__)
  const __m128i middle = _mm_set1_epi8(static_cast<char>(kMiddle));
  for (; i + 16 <= bytes.size(); i += 16)
    store_bytes(to + i, _mm_add_epi8(_mm_sub_epi8(load_bytes(from + i), load_bytes(from + i - 1)), middle));
#endif
  for (; i < bytes.size(); ++i) to[i] = static_cast<std::uint8_t>(from[i] - from[i - 1] + kMiddle);
}

}  // namespace

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
  packed.resize(deflate_.stream(from, packed));
  if (packed.empty() || packed.size() >= bytes.size()) return bytes;
  return packed;
}

void ExrZip::append(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& packed) {
  append_plain(differences(bytes), packed);
}

void ExrZip::append_plain(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& packed) {
  const std::size_t at = packed.size();
  packed.resize(at + Deflate::bound(bytes.size()));
  packed.resize(at + deflate_.stream(bytes, std::span(packed).subspan(at)));
}

ExrUnzip::ExrUnzip() : inflate_(libdeflate_alloc_decompressor()) {
  if (inflate_ == nullptr) throw std::bad_alloc();
}

ExrUnzip::~ExrUnzip() { libdeflate_free_decompressor(inflate_); }

bool ExrUnzip::run(std::span<const std::uint8_t> packed, std::span<std::uint8_t> bytes, std::span<std::uint8_t> apart) {
  const auto done = libdeflate_zlib_decompress(inflate_, packed.data(), packed.size(), apart.data(), apart.size(),
                                               nullptr);  // no length asked for: it must be exactly this
  if (done != LIBDEFLATE_SUCCESS) return false;
  add_up(apart);
  put_together(apart, bytes);
  return true;
}

}  // namespace afterglow
