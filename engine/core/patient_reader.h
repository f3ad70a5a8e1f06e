// SPDX-License-Identifier: MIT
// Reads that come back: what gives no bytes (a pipe whose writer hangs, a file of a network that is gone) is given up.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "core/file_descriptor.h"
#include "core/patience.h"
#include "core/result.h"

namespace afterglow {

/// Pipes and devices are asked whether there is anything. Files are always said to be ready and then keep a read for as
/// long as they like: what does not lie in memory is read by a thread, which stays behind if it must. Not thread-safe.
class PatientReader {
 public:
  /// `cancelled`: one more that may give up; it outlives the reader.
  PatientReader(std::shared_ptr<FileDescriptor> from, Patience patience, const std::atomic<bool>* cancelled = nullptr);
  ~PatientReader();
  PatientReader(const PatientReader&) = delete;
  PatientReader& operator=(const PatientReader&) = delete;

  /// From where the descriptor stands: at least a byte, or 0 at the end. Errors, without a file: io (as the system
  /// says, or the time is over), interrupted (given up). Of the last two all later reads end at once.
  Result<std::size_t> read(void* to, std::size_t size);
  /// The descriptor's own; not while a read was given up.
  int descriptor() const { return from_->get(); }

 private:
  struct Worker;
  class Wait;
  Result<std::size_t> read_when_ready(void* to, std::size_t size);
  Result<std::size_t> read_file(void* to, std::size_t size);
  Result<std::size_t> read_by_worker(void* to, std::size_t size);
  bool start_worker();
  Result<std::size_t> read_now(void* to, std::size_t size);

  std::shared_ptr<FileDescriptor> from_;
  Patience patience_;
  const std::atomic<bool>* cancelled_;
  bool is_file_ = false;
  bool asks_memory_ = true;  ///< the system can tell what lies in memory
  std::shared_ptr<Worker> worker_;
  std::optional<Error> over_;
};

}  // namespace afterglow
