// SPDX-License-Identifier: MIT
// Where finished frames go: files of their own, one video, or standard output.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "batch/frame_list.h"
#include "core/diagnostics.h"
#include "core/hash.h"
#include "core/result.h"
#include "image/picture.h"
#include "image/writer.h"

namespace afterglow {

struct FrameLoopOptions;

/// Not thread-safe but for `write`. Errors: io, usage.
class FrameSink {
 public:
  /// Waits until all frames before have been written; the error of one that could not be.
  using Turn = std::function<Result<void>()>;

  virtual ~FrameSink() = default;

  /// All frames go into one thing, in order: what cannot be written ends the run.
  virtual bool is_one() const { return true; }
  /// How it will make 8-bit display codes of a frame, so that the device can; nothing when it makes anything else.
  virtual std::optional<DisplayCodes> codes(const FrameJob&, bool /*has_alpha*/, const FileFacts*) const {
    return std::nullopt;
  }
  /// Whether a frame can stand with those before: an error is its own, and its place stays empty. Asked before `write`,
  /// in order, by one thread. Errors: io (of another size).
  virtual Result<void> takes(const FrameJob&, const Picture&) { return {}; }
  /// A frame; `index` is its place among those that the run was asked for, from 0; the places of frames that failed are
  /// left out. Called from several threads. Where is_one(), what it does behind `turn` is done by one at a time and in
  /// order.
  virtual Result<void> write(const FrameJob& job, std::size_t index, const Picture& picture, const Turn& turn) = 0;
  /// Memory that writing a frame takes besides the frame; what the sink holds of earlier frames. Bytes, for
  /// --max-memory.
  virtual std::uint64_t bytes_of_frame(const FrameJob&, Size, bool /*has_alpha*/, const FileFacts*) const { return 0; }
  virtual std::uint64_t bytes_held(Size) const { return 0; }
  /// All that can come has come, of so many frames that were asked for (0: of those that came): what was written
  /// appears. Without this call it goes.
  virtual Result<void> finish(std::size_t /*frames*/) { return {}; }
};

/// Of what holds pictures of one size: that of the first one.
class OneSize {
 public:
  /// Errors: io (another size).
  Result<void> takes(const FrameJob& job, const Picture& picture);

 private:
  std::optional<Size> first_;
};

/// For the output of `files`, into which so many frames are known to go; `last`: of them, null while none is. Errors:
/// usage (options that do not go with this output), io (it cannot be written; see check_output).
Result<std::unique_ptr<FrameSink>> open_sink(const FrameListRequest& files, const FrameLoopOptions& options,
                                             std::size_t frames, const FrameJob* last, Diagnostics& diagnostics);

/// Can pictures of these names be written? One of each folder and format is looked at. Errors: usage (a format), io (a
/// place).
Result<void> check_pictures(const std::vector<std::filesystem::path>& outputs, const FrameListRequest& files,
                            const WriteOptions& options);

}  // namespace afterglow
