// SPDX-License-Identifier: MIT
// Packed bytes, against zlib's own reading of them.
#include <gtest/gtest.h>
#include <zlib.h>

#include <memory>
#include <random>
#include <vector>

#include "image/deflate.h"

namespace afterglow {
namespace {

using ByteVector = std::vector<std::uint8_t>;

ByteVector noise(std::size_t count, int symbols) {
  std::mt19937 random(11);
  ByteVector bytes(count);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random() % static_cast<unsigned>(symbols));
  return bytes;
}

ByteVector unpacked(std::span<const std::uint8_t> packed, std::size_t count) {
  ByteVector bytes(count + 1);
  auto length = static_cast<uLongf>(bytes.size());
  EXPECT_EQ(uncompress(bytes.data(), &length, packed.data(), static_cast<uLong>(packed.size())), Z_OK);
  bytes.resize(length);
  return bytes;
}

/// Of every kind: nothing, zeros, such as get shorter, such as do not.
std::vector<ByteVector> samples() {
  std::vector<ByteVector> out;
  for (const std::size_t count : {0, 1, 2, 15, 300, 4097, 65535, 65536, 65537, 1 << 20, 3000001})
    for (const int symbols : {1, 5, 256}) out.push_back(noise(count, symbols));
  return out;
}

TEST(Deflate, StreamsAreReadByZlib) {
  for (const int level : {0, 1, 2, 6, 9}) {
    Deflate deflate(level);  // one for all: what is left from one call means nothing to the next
    for (const ByteVector& bytes : samples()) {
      if (level > 2 && bytes.size() > 100000) continue;
      ByteVector packed(Deflate::bound(bytes.size()));
      const std::size_t length = deflate.stream(bytes, packed);
      ASSERT_GT(length, 0u) << level << " " << bytes.size();
      EXPECT_EQ(unpacked(std::span(packed).first(length), bytes.size()), bytes) << level << " " << bytes.size();
    }
  }
}

TEST(Deflate, WhatDoesNotFitIsNotTaken) {
  for (const int level : {1, 4}) {
    Deflate deflate(level);
    const ByteVector bytes = noise(70000, 256);
    ByteVector packed(bytes.size());
    EXPECT_EQ(deflate.stream(bytes, packed), 0u) << level;
    packed.resize(Deflate::bound(bytes.size()));
    const std::size_t length = deflate.stream(bytes, packed);
    ASSERT_GT(length, 0u);
    for (const std::size_t less : {std::size_t{1}, std::size_t{5}, length - 1, length})
      EXPECT_EQ(deflate.stream(bytes, std::span(packed).first(length - less)), 0u) << level << " " << less;
  }
}

TEST(Deflate, PiecesMakeOneStream) {
  if (!Deflate::makes_pieces(1)) GTEST_SKIP() << "built without ISA-L";
  for (const int symbols : {1, 5, 256})
    for (const std::size_t piece : {std::size_t{1}, std::size_t{700}, std::size_t{65536}, std::size_t{524288}}) {
      const ByteVector bytes = noise(piece < 100 ? 40 : 1200000, symbols);
      ByteVector whole(std::begin(kStreamHead), std::end(kStreamHead));
      std::uint32_t sum = 1;
      for (std::size_t at = 0; at < bytes.size(); at += piece) {
        Deflate deflate(1);  // another thread's
        const auto part = std::span(bytes).subspan(at, std::min(piece, bytes.size() - at));
        ByteVector packed(Deflate::bound(part.size()));
        const std::size_t length = deflate.piece(part, at + piece >= bytes.size(), packed);
        ASSERT_GT(length, 0u) << symbols << " " << piece;
        whole.insert(whole.end(), packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(length));
        sum = adler32_of(sum, adler32_of(part), part.size());
      }
      for (int shift = 24; shift >= 0; shift -= 8) whole.push_back(static_cast<std::uint8_t>(sum >> shift));
      EXPECT_EQ(unpacked(whole, bytes.size()), bytes) << symbols << " " << piece;
    }
}

TEST(Deflate, TheSameBytesEachTime) {
  Deflate first(1), second(1);
  const ByteVector bytes = noise(300000, 60);
  ByteVector a(Deflate::bound(bytes.size())), b = a;
  for (int i = 0; i < 3; ++i) {
    a.assign(a.size(), static_cast<std::uint8_t>(i));
    const std::size_t length = first.stream(bytes, a);
    ASSERT_EQ(second.stream(bytes, b), length);
    EXPECT_TRUE(std::equal(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(length), b.begin()));
  }
}

/// Packers lie at other addresses in every run; here, many at a time.
TEST(Deflate, TheSameBytesWhereverThePackerLies) {
  std::vector<ByteVector> expected;
  std::vector<std::unique_ptr<Deflate>> packers;
  const std::vector<ByteVector> pictures = {noise(60, 2), noise(192, 2), noise(192, 3), noise(700, 2), noise(3000, 4)};
  for (int i = 0; i < 1500; ++i) {
    packers.push_back(std::make_unique<Deflate>(1));
    std::vector<ByteVector> packed;
    for (const ByteVector& bytes : pictures) {
      packed.emplace_back(Deflate::bound(bytes.size()));
      packed.back().resize(packers.back()->stream(bytes, packed.back()));
    }
    if (i == 0) expected = packed;
    ASSERT_EQ(packed, expected) << i;
  }
}

}  // namespace
}  // namespace afterglow
