// SPDX-License-Identifier: MIT
// A file that is being written, which remembers its first failure: libraries that write pictures do not always look at,
// or pass on, what a write returned. Behind it stands a plain file descriptor.
#pragma once

#include <OpenEXR/ImfIO.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace afterglow {

/// Buffered, seekable. Not thread-safe.
class OutputFile {
 public:
  /// Creates `path`, which must not exist. Look at failure() before use.
  explicit OutputFile(const std::filesystem::path& path);
  /// Takes an open file, which can seek.
  explicit OutputFile(int descriptor);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  bool write(const void* data, std::size_t size);
  bool read(void* data, std::size_t size);  ///< what was written before; TIFF looks back
  void seek(std::uint64_t position) { position_ = position; }
  std::uint64_t position() const { return position_; }
  std::uint64_t size() const { return size_; }
  bool flush();
  /// Flushes and closes. Errors: io (the first failure of any call).
  Result<void> close();
  /// Number of the first system error, or 0.
  int failure() const { return failure_; }

 private:
  bool fail(int number);

  int descriptor_ = -1, failure_ = 0;
  std::uint64_t position_ = 0, size_ = 0, buffer_begin_ = 0;
  std::vector<char> buffer_;
};

/// The same file as OpenEXR wants to see it.
class ExrOutput : public Imf::OStream {
 public:
  ExrOutput(OutputFile& file, const char* name) : Imf::OStream(name), file_(file) {}
  void write(const char data[], int size) override;  ///< throws, as OpenEXR asks for
  std::uint64_t tellp() override { return file_.position(); }
  void seekp(std::uint64_t position) override { file_.seek(position); }

 private:
  OutputFile& file_;
};

}  // namespace afterglow
