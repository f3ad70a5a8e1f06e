// SPDX-License-Identifier: MIT
#include "image/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "core/file_time.h"

namespace afterglow {
namespace {
constexpr std::size_t kBufferSize = 256 << 10;
}

OutputFile::OutputFile(const std::filesystem::path& path) {
  constexpr mode_t kMode = 0666;  // less what umask takes
  buffer_.reserve(kBufferSize);   // nothing is open yet when there is no memory
  descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kMode);
  if (descriptor_ < 0) fail(errno);
}

OutputFile::OutputFile(int descriptor) : descriptor_(descriptor) {
  if (descriptor_ < 0) fail(errno);
  buffer_.reserve(kBufferSize);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool OutputFile::fail(int number) {
  if (failure_ == 0) failure_ = number != 0 ? number : EIO;
  return false;
}

bool OutputFile::write(const void* data, std::size_t size) {
  if (failure_) return false;
  if (position_ != buffer_begin_ + buffer_.size() || buffer_.size() + size > kBufferSize) {
    if (!flush()) return false;
    buffer_begin_ = position_;
  }
  if (size > kBufferSize) {
    const FileTime time;
    const auto* bytes = static_cast<const char*>(data);
    for (std::size_t done = 0; done < size;) {
      const ssize_t written = ::pwrite(descriptor_, bytes + done, size - done, static_cast<off_t>(position_ + done));
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return fail(written < 0 ? errno : ENOSPC);
      done += static_cast<std::size_t>(written);
    }
    buffer_begin_ = position_ + size;
  } else {
    const auto* bytes = static_cast<const char*>(data);
    buffer_.insert(buffer_.end(), bytes, bytes + size);
  }
  position_ += size;
  size_ = std::max(size_, position_);
  return true;
}

bool OutputFile::flush() {
  if (failure_) return false;
  const FileTime time;
  for (std::size_t done = 0; done < buffer_.size();) {
    const ssize_t written =
        ::pwrite(descriptor_, buffer_.data() + done, buffer_.size() - done, static_cast<off_t>(buffer_begin_ + done));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return fail(written < 0 ? errno : ENOSPC);
    done += static_cast<std::size_t>(written);
  }
  buffer_begin_ += buffer_.size();
  buffer_.clear();
  return true;
}

bool OutputFile::read(void* data, std::size_t size) {
  if (!flush()) return false;
  auto* bytes = static_cast<char*>(data);
  for (std::size_t done = 0; done < size;) {
    const ssize_t got = ::pread(descriptor_, bytes + done, size - done, static_cast<off_t>(position_ + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;  // beyond the end: no failure of the file
    done += static_cast<std::size_t>(got);
  }
  position_ += size;
  return true;
}

Result<void> OutputFile::close() {
  if (descriptor_ >= 0) {
    flush();
    const FileTime time;
    if (::close(descriptor_) != 0) fail(errno);  // network file systems report a full disk here
    descriptor_ = -1;
  }
  if (failure_) return Error{ErrorKind::io, fmt::format("cannot be written: {}", std::strerror(failure_))};
  return {};
}

void ExrOutput::write(const char data[], int size) {
  if (!file_.write(data, static_cast<std::size_t>(size))) throw std::runtime_error(std::strerror(file_.failure()));
}

}  // namespace afterglow
