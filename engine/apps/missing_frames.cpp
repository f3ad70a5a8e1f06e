// SPDX-License-Identifier: MIT
#include "apps/missing_frames.h"

#include <fmt/format.h>

#include <utility>

#include "core/exception.h"
#include "image/sequence.h"

namespace afterglow {
MissingFrames::~MissingFrames() {
  try {
    tell_kept();
  } catch (const std::exception&) {  // there is no memory for the message
  }
}

bool MissingFrames::continues(const Error& error) const {
  const auto number = own_frame_number(error.file);
  if (!first_ || !number || without_frame_number(error.file) != without_frame_number(first_->file)) return false;
  const int step = *number - number_;
  return step > 0 && (count_ == 1 || step == step_);
}

void MissingFrames::next() {
  if (!std::exchange(added_, false)) tell_kept();
}

void MissingFrames::add(const Error& error) {
  added_ = true;
  const bool absent = error.message == "no such file" && error.trail.empty() && own_frame_number(error.file);
  if (absent && continues(error)) {
    const int number = *own_frame_number(error.file);
    step_ = number - number_;
    number_ = number;
    last_ = error.file;
    ++count_;
    return;
  }
  tell_kept();
  if (!absent) return tell_(error);
  first_ = error;
  number_ = *own_frame_number(error.file);
  count_ = 1;
}

void MissingFrames::tell_kept() {
  if (!first_) return;
  Error error = *std::move(first_);
  first_.reset();
  if (count_ > 1)
    error.message = fmt::format("no such file, and {} more up to {} are not there", count_ - 1,
                                std::filesystem::path(last_).filename().string());
  tell_(error);
}

}  // namespace afterglow
