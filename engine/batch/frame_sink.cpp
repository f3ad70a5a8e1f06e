// SPDX-License-Identifier: MIT
#include "batch/frame_sink.h"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "batch/frame_plan.h"
#include "batch/resume.h"
#include "batch/stream_sink.h"
#include "batch/video_sink.h"
#include "core/text.h"
#include "image/video_writer.h"

namespace afterglow {
namespace {

/// A file a frame.
class FileSink : public FrameSink {
 public:
  FileSink(const WriteOptions& options, std::filesystem::path folder, Diagnostics& diagnostics)
      : options_(options), folder_(std::move(folder)), diagnostics_(diagnostics) {
    options_.memory = &memory_;
  }

  bool is_one() const override { return false; }
  std::optional<DisplayCodes> codes(const FrameJob& job, bool has_alpha, const FileFacts* facts) const override {
    return display_codes(job.output, options_, has_alpha, facts);
  }
  Result<void> write(const FrameJob& job, std::size_t, const Picture& picture, const Turn&) override {
    AFTERGLOW_CHECK(make_folder(folder_));
    std::string stamp;
    AFTERGLOW_CHECK(write_picture(picture, job.output, options_, diagnostics_, &stamp));
    if (const auto noted = record_made(job, stamp); !noted)
      diagnostics_.warn_once("notes", fmt::format("{}: {}; --resume will make such frames again", noted.error().file,
                                                  noted.error().message));
    return {};
  }
  std::uint64_t bytes_of_frame(const FrameJob& job, Size size, bool has_alpha, const FileFacts* facts) const override {
    return write_bytes(job.output, options_, size, has_alpha, facts);
  }

 private:
  WorkMemory memory_;
  WriteOptions options_;
  std::filesystem::path folder_;  ///< that is made for them, or empty
  Diagnostics& diagnostics_;
};

/// An option that was given and that only videos take; empty: none. A stream may be a video without a file.
const char* option_of_videos(const FrameLoopOptions& options, bool stream) {
  const VideoOptions& video = options.write.video;
  if (!video.codec.empty()) return "--codec";
  if (video.crf) return "--crf";
  if (!video.bitrate.empty()) return "--bitrate";
  if (!video.audio.empty()) return "--audio";
  if (!stream && !video.pixel_format.empty()) return "--pix-fmt";
  return !stream && options.keep_partial ? "--keep-partial" : "";
}

}  // namespace

Result<void> OneSize::takes(const FrameJob& job, const Picture& picture) {
  const Size size = picture.display_window.size();
  if (!first_) first_ = size;
  if (size == *first_) return {};
  return Error{ErrorKind::io,
               fmt::format("frame {} has {}x{} pixels, the first had {}x{}; a video has one size", job.frame,
                           size.width, size.height, first_->width, first_->height),
               job.input.string()};
}

Result<std::unique_ptr<FrameSink>> open_sink(const FrameListRequest& files, const FrameLoopOptions& options,
                                             std::size_t frames, const FrameJob* last, Diagnostics& diagnostics) {
  if (is_video_output(files.output))
    return open_video_sink(files.output, options.write, options.fps, last, diagnostics);
  const bool stream = files.output == "-";
  if (const std::string option = option_of_videos(options, stream); !option.empty())
    return Error{ErrorKind::usage, fmt::format("{} is for videos", option), stream ? "standard output" : files.output,
                 0, join(video_extensions())};
  if (stream) return open_stream_sink(files.extension, options.write, options.fps, frames, diagnostics);
  return std::unique_ptr<FrameSink>(std::make_unique<FileSink>(options.write, new_folder(files.output), diagnostics));
}

Result<void> check_pictures(const std::vector<std::filesystem::path>& outputs, const FrameListRequest& files,
                            const WriteOptions& options) {
  std::set<std::pair<std::filesystem::path, std::filesystem::path>> seen;
  const bool is_there = new_folder(files.output).empty();
  for (const auto& output : outputs) {
    if (!seen.emplace(output.parent_path(), output.extension()).second) continue;
    AFTERGLOW_CHECK(check_format(output, options));
    if (is_there) AFTERGLOW_CHECK(check_place(output));
  }
  return {};
}

}  // namespace afterglow
