// SPDX-License-Identifier: MIT
// Chunks of ZIP in EXR files, against those that OpenEXR's own documentation of the file layout describes.
#include <gtest/gtest.h>
#include <zlib.h>

#include <random>

#include "image/exr_zip.h"

namespace afterglow {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Bytes at even places, then those at odd ones; each as its difference from the one before, around 128; deflated.
Bytes packed(const Bytes& bytes) {
  Bytes apart;
  for (std::size_t i = 0; i < bytes.size(); i += 2) apart.push_back(bytes[i]);
  for (std::size_t i = 1; i < bytes.size(); i += 2) apart.push_back(bytes[i]);
  Bytes stored = apart;
  for (std::size_t i = 1; i < apart.size(); ++i) stored[i] = static_cast<std::uint8_t>(apart[i] - apart[i - 1] + 128);
  uLongf length = compressBound(static_cast<uLong>(stored.size()));
  Bytes out(length);
  EXPECT_EQ(compress2(out.data(), &length, stored.data(), static_cast<uLong>(stored.size()), 4), Z_OK);
  out.resize(length);
  return out;
}

Bytes random_bytes(std::size_t count) {
  std::mt19937 random(7);
  Bytes bytes(count);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

/// With room to work in.
class Unzip {
 public:
  bool run(std::span<const std::uint8_t> packed, Bytes& out) {
    Bytes apart(out.size());
    return unzip_.run(packed, out, apart);
  }

 private:
  ExrUnzip unzip_;
};

TEST(ExrUnzip, GivesBackChunksOfEveryLength) {
  Unzip unzip;
  for (const std::size_t count : {1, 2, 3, 15, 16, 17, 18, 31, 33, 34, 1000, 4097, 100001}) {
    const Bytes bytes = random_bytes(count);
    Bytes out(count);
    ASSERT_TRUE(unzip.run(packed(bytes), out)) << count;
    EXPECT_EQ(out, bytes) << count;
  }
}

TEST(ExrUnzip, RefusesOtherLengthsAndDamage) {
  Unzip unzip;
  const Bytes bytes = random_bytes(500);
  const Bytes whole = packed(bytes);
  Bytes longer(501), shorter(499), out(500);
  EXPECT_FALSE(unzip.run(whole, longer));
  EXPECT_FALSE(unzip.run(whole, shorter));
  EXPECT_FALSE(unzip.run({whole.data(), whole.size() / 2}, out));
  EXPECT_FALSE(unzip.run({}, out));
  Bytes broken = whole;
  broken.back() ^= 1;  // its checksum
  EXPECT_FALSE(unzip.run(broken, out));
  EXPECT_TRUE(unzip.run(whole, out));
}

TEST(ExrZip, IsUnpackedToTheSameBytes) {
  Unzip unzip;
  for (const int level : {1, 4, 9}) {
    ExrZip zip(level);
    for (const std::size_t count : {1, 2, 3, 15, 16, 17, 33, 1000, 4097, 100001}) {
      Bytes bytes = random_bytes(count);
      for (auto& byte : bytes) byte &= 3;
      Bytes packed, out(count);
      const auto stored = zip.run(bytes, packed);
      ASSERT_LE(stored.size(), count);
      if (count > 1000) {
        ASSERT_LT(stored.size(), count / 2);
      }
      if (stored.size() == count) continue;
      ASSERT_TRUE(unzip.run(stored, out)) << count;
      EXPECT_EQ(out, bytes) << count;
    }
  }
}

TEST(ExrZip, StoresNoiseAsItIs) {
  ExrZip zip(1);
  Bytes packed;
  const Bytes bytes = random_bytes(5000);
  const auto stored = zip.run(bytes, packed);
  EXPECT_EQ(stored.data(), bytes.data());
  EXPECT_EQ(stored.size(), bytes.size());
}

}  // namespace
}  // namespace afterglow
