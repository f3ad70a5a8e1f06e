// SPDX-License-Identifier: MIT
#include "image/video_writer.h"

#include <fmt/format.h>

#include <system_error>

#include "core/exception.h"
#include "core/file.h"
#include "core/temporary.h"
#include "core/text.h"
#include "image/ffmpeg_module.h"

namespace afterglow {
namespace fs = std::filesystem;

Result<void> check_video_encoder(const VideoPlan& plan, const fs::path& file) {
  AFTERGLOW_TRY(const FfmpegModule* module, ffmpeg_module());
  for (const auto& encoder : plan.encoders)
    if (module->has_encoder(encoder)) return {};
  return Error{ErrorKind::usage, fmt::format("this FFmpeg has no encoder for {} ({})", plan.codec, join(plan.encoders)),
               file.string()};
}

Result<std::unique_ptr<VideoWriter>> VideoWriter::open(const fs::path& file, VideoPlan plan, Diagnostics& diagnostics) {
  AFTERGLOW_CHECK(check_video_size(plan, plan.size, file));
  AFTERGLOW_TRY(const FfmpegModule* module, ffmpeg_module());
  std::unique_ptr<VideoWriter> writer(new VideoWriter());
  writer->file_ = file;
  std::error_code ec;
  writer->target_ = fs::is_symlink(file, ec) ? fs::weakly_canonical(file, ec) : file;
  writer->temporary_ = temporary_beside(writer->target_);
  writer->plan_ = std::move(plan);
  writer->out_ = std::make_unique<OutputFile>(writer->temporary_);
  if (writer->out_->failure()) return writer->named(writer->out_->close().error());
  auto encoder = module->encode(writer->plan_, *writer->out_, writer->temporary_, file.string(), diagnostics);
  if (!encoder) return writer->named(std::move(encoder).error());
  writer->encoder_ = std::move(*encoder);
  return writer;
}

VideoWriter::~VideoWriter() {
  encoder_.reset();
  out_.reset();
  std::error_code ignored;
  if (!committed_) fs::remove(temporary_, ignored);
}

/// What the file itself reports ("No space left on device") goes before what a library makes of it.
Error VideoWriter::named(Error error) const {
  if (out_ && out_->failure() != 0) error = out_->close().error();
  if (error.file.empty() || error.file == temporary_) error.file = file_.string();
  return error;
}

Result<void> VideoWriter::write(const Picture& picture, VideoTime time) {
  const Size size = picture.display_window.size();
  if (size != plan_.size)
    return Error{ErrorKind::usage,
                 fmt::format("a frame has {}x{} pixels, the first had {}x{}; a video has one size", size.width,
                             size.height, plan_.size.width, plan_.size.height),
                 file_.string()};
  try {
    if (auto written = encoder_->write(pack_frame(picture, plan_.pack), time); !written)
      return named(std::move(written).error());
    if (out_->failure() != 0) return named({});
  } catch (const std::exception& error) {
    return Error{ErrorKind::io, "cannot be written: " + exception_text(error), file_.string()};
  }
  return {};
}

Result<void> VideoWriter::finish(bool whole) {
  if (auto finished = encoder_->finish(whole); !finished) return named(std::move(finished).error());
  if (auto closed = out_->close(); !closed) return named(std::move(closed).error());
  std::error_code ec;
  if (fs::file_size(temporary_, ec) != out_->size() || ec)
    return Error{ErrorKind::io, "cannot be written: the file has lost bytes", file_.string()};
  committed_ = true;  // commit_file removes it when it fails
  return commit_file(temporary_, target_);
}

}  // namespace afterglow
