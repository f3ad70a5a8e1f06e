// SPDX-License-Identifier: MIT
// A video's file while it is made: it lies beside its name and gets it at the end, whole or not at all.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "core/result.h"
#include "core/temporary.h"
#include "image/output_file.h"

namespace afterglow {

/// Without commit() nothing stays. Not thread-safe.
class VideoTarget {
 public:
  /// Errors: io (it cannot be made).
  static Result<std::unique_ptr<VideoTarget>> open(const std::filesystem::path& file);

  OutputFile& out() { return *out_; }
  const std::filesystem::path& file() const { return file_; }
  const std::filesystem::path& temporary() const { return temporary_->path(); }
  /// What the file itself reports ("No space left on device") goes before what a library makes of it.
  Error named(Error error) const;
  /// Gives it its name. Errors: io (disk full, …).
  Result<void> commit();

 private:
  VideoTarget() = default;

  std::filesystem::path file_;
  std::optional<Temporary> temporary_;
  std::unique_ptr<OutputFile> out_;  ///< of the temporary file: closed before that is gone
};

}  // namespace afterglow
