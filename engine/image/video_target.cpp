// SPDX-License-Identifier: MIT
#include "image/video_target.h"

#include <system_error>
#include <utility>

#include "image/lost_file.h"

namespace afterglow {
namespace fs = std::filesystem;

Result<std::unique_ptr<VideoTarget>> VideoTarget::open(const fs::path& file) {
  std::unique_ptr<VideoTarget> target(new VideoTarget());
  target->file_ = file;
  target->temporary_.emplace(file);
  target->out_ = std::make_unique<OutputFile>(target->temporary());
  if (target->out_->failure()) return target->named(target->out_->close().error());
  return target;
}

Error VideoTarget::named(Error error) const {
  if (out_->failure() != 0) error = out_->close().error();
  if (error.file.empty() || error.file == temporary()) error.file = file_.string();
  return error;
}

Result<void> VideoTarget::commit() {
  if (auto closed = out_->close(); !closed) return named(std::move(closed).error());
  std::error_code ec;
  if (fs::file_size(temporary(), ec) != out_->size() || ec) return named(lost_file(temporary()));
  return temporary_->commit();
}

}  // namespace afterglow
