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

bool MissingFrames::continues(const std::string& file, int number) const {
  if (!first_ || without_frame_number(file) != without_frame_number(first_->file)) return false;
  const int step = number - number_;
  return step > 0 && (count_ == 1 || step == step_);
}

void MissingFrames::next() {
  if (!std::exchange(added_, false)) tell_kept();
}

void MissingFrames::add(const Error& error) {
  added_ = true;
  const bool absent = error.message == "no such file" && error.trail.empty();
  const auto number = absent ? own_frame_number(error.file) : std::nullopt;
  if (number && continues(error.file, *number)) {
    step_ = *number - number_;
    number_ = *number;
    last_ = error.file;
    ++count_;
    return;
  }
  tell_kept();
  if (!number) return tell_(error);
  first_ = error;
  number_ = *number;
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
