// SPDX-License-Identifier: MIT
#include "image/memory_file.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

namespace afterglow {
namespace {

Error failed() { return Error{ErrorKind::io, fmt::format("a file in memory failed: {}", std::strerror(errno))}; }

}  // namespace

MemoryFile::MemoryFile(int descriptor) : descriptor_(descriptor), name_(fmt::format("/proc/self/fd/{}", descriptor)) {}

MemoryFile::MemoryFile(MemoryFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), name_(std::move(other.name_)) {}

MemoryFile& MemoryFile::operator=(MemoryFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(name_, other.name_);
  return *this;
}

MemoryFile::~MemoryFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

Result<MemoryFile> MemoryFile::create() {
  const int descriptor = memfd_create("afterglow", MFD_CLOEXEC);
  if (descriptor < 0) return failed();
  return MemoryFile(descriptor);
}

Result<void> MemoryFile::copy_to(OutputFile& out) const {
  constexpr std::size_t kChunk = 1 << 20;
  std::vector<char> chunk(kChunk);
  for (off_t at = 0;;) {
    const ssize_t got = pread(descriptor_, chunk.data(), chunk.size(), at);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return failed();
    if (got == 0 || !out.write(chunk.data(), static_cast<std::size_t>(got))) return {};
    at += got;
  }
}

}  // namespace afterglow
