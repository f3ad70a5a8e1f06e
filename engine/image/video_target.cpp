// SPDX-License-Identifier: MIT
#include "image/video_target.h"

#include <system_error>
#include <utility>

#include "core/file.h"
#include "core/temporary.h"

namespace afterglow {
namespace fs = std::filesystem;

Result<std::unique_ptr<VideoTarget>> VideoTarget::open(const fs::path& file) {
  std::unique_ptr<VideoTarget> target(new VideoTarget());
  std::error_code ec;
  target->file_ = file;
  target->target_ = fs::is_symlink(file, ec) ? fs::weakly_canonical(file, ec) : file;
  target->temporary_ = temporary_beside(target->target_);
  target->out_ = std::make_unique<OutputFile>(target->temporary_);
  if (target->out_->failure()) return target->named(target->out_->close().error());
  return target;
}

VideoTarget::~VideoTarget() {
  out_.reset();
  std::error_code ignored;
  if (!committed_) fs::remove(temporary_, ignored);
}

Error VideoTarget::named(Error error) const {
  if (out_->failure() != 0) error = out_->close().error();
  if (error.file.empty() || error.file == temporary_) error.file = file_.string();
  return error;
}

Result<void> VideoTarget::commit() {
  if (auto closed = out_->close(); !closed) return named(std::move(closed).error());
  std::error_code ec;
  if (fs::file_size(temporary_, ec) != out_->size() || ec)
    return Error{ErrorKind::io, "cannot be written: the file has lost bytes", file_.string()};
  committed_ = true;  // commit_file removes it when it fails
  return commit_file(temporary_, target_);
}

}  // namespace afterglow
