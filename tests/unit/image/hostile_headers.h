// SPDX-License-Identifier: MIT
// Headers that ask for more than they bring, one test a trick: refused before memory is taken, in words that are true.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "make_files.h"
#include "memory_cap.h"
#include "temporary_folder.h"

namespace afterglow {

/// The lowest `bytes` of a number, the least first.
inline std::string little(std::uint64_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i, value >>= 8) out += static_cast<char>(value);
  return out;
}

/// The same, the highest byte first.
inline std::string big(std::uint64_t value, int bytes) {
  std::string out = little(value, bytes);
  std::reverse(out.begin(), out.end());
  return out;
}

class HostileHeaders : public testing::Test {
 protected:
  Error refused(const std::string& bytes, const ReadOptions& options = {}) {
    write_bytes(folder_ / "hostile", bytes);
    const MemoryCap cap;
    Diagnostics silent;
    const auto picture = read_picture(folder_ / "hostile", options, silent);
    EXPECT_FALSE(picture);
    if (picture) return {};
    EXPECT_EQ(picture.error().kind, ErrorKind::io);
    EXPECT_EQ(picture.error().file, (folder_ / "hostile").string());
    return picture.error();
  }
  TemporaryFolder folder_;
};

}  // namespace afterglow
