// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <fstream>

#include "image/memory_file.h"
#include "make_files.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {

TEST(MemoryFile, IsOpenedByItsNameAndCopiedWhole) {
  const TemporaryFolder folder;
  auto file = MemoryFile::create();
  ASSERT_TRUE(file) << file.error().text();
  std::string bytes(3'000'001, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 7919 >> 5);
  std::ofstream(file->name(), std::ios::binary) << bytes;
  const MemoryFile moved = std::move(*file);
  OutputFile out(folder / "copy");
  ASSERT_TRUE(moved.copy_to(out));
  ASSERT_TRUE(out.close());
  EXPECT_TRUE(file_bytes(folder / "copy") == bytes);
}

}  // namespace
}  // namespace afterglow
