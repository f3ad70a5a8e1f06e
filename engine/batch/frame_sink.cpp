// SPDX-License-Identifier: MIT
#include "batch/frame_sink.h"

#include "batch/resume.h"
#include "batch/stream_sink.h"
#include "batch/video_sink.h"
#include "image/video_writer.h"

namespace afterglow {
namespace {

/// A file a frame.
class FileSink : public FrameSink {
 public:
  FileSink(const WriteOptions& options, Diagnostics& diagnostics) : options_(options), diagnostics_(diagnostics) {
    options_.memory = &memory_;
  }

  bool is_one() const override { return false; }
  std::optional<DisplayCodes> codes(const FrameJob& job, bool has_alpha, const FileFacts* facts) const override {
    return display_codes(job.output, options_, has_alpha, facts);
  }
  Result<void> write(const FrameJob& job, std::size_t, const Picture& picture, const Turn&) override {
    AFTERGLOW_CHECK(write_picture(picture, job.output, options_, diagnostics_));
    return look_ ? record_made(job, *look_) : Result<void>();
  }
  std::uint64_t bytes_of_frame(const FrameJob& job, Size size, bool has_alpha, const FileFacts* facts) const override {
    return write_bytes(job.output, options_, size, has_alpha, facts);
  }
  void record_look(const Hash& look) override { look_ = look; }

 private:
  WorkMemory memory_;
  WriteOptions options_;
  Diagnostics& diagnostics_;
  std::optional<Hash> look_;
};

}  // namespace

Result<std::unique_ptr<FrameSink>> open_sink(const FrameListRequest& files, const WriteOptions& options, double fps,
                                             std::size_t frames, Diagnostics& diagnostics) {
  if (files.output == "-") return open_stream_sink(files.extension, options, fps, frames, diagnostics);
  if (is_video_output(files.output)) return open_video_sink(files.output, options, fps, diagnostics);
  return std::unique_ptr<FrameSink>(std::make_unique<FileSink>(options, diagnostics));
}

}  // namespace afterglow
