// SPDX-License-Identifier: MIT
#include "image/video_writer.h"

#include <fmt/format.h>

#include "core/exception.h"
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
  const OutputSpace& space = *plan.pack.space;
  if ((plan.container == "gif" || plan.container == "apng") && (must_be_told(space) || !space.of_display()))
    diagnostics.warn(fmt::format("{}: {} files do not say that they hold '{}': players take them for sRGB{}",
                                 file.filename().string(), plan.container, space.name(),
                                 space.of_display() ? "" : ", and 8 bits show steps in it"));
  if (plan.shows_steps)
    diagnostics.warn(
        fmt::format("{}: {} with alpha has 8 bits, which show steps in this --output-space; --pix-fmt "
                    "yuv420p10le has 10, without alpha",
                    file.filename().string(), plan.codec));
  AFTERGLOW_CHECK(check_video_size(plan, plan.size, file));
  AFTERGLOW_TRY(const FfmpegModule* module, ffmpeg_module());
  std::unique_ptr<VideoWriter> writer(new VideoWriter());
  writer->plan_ = std::move(plan);
  AFTERGLOW_TRY(writer->plan_.patience, patience_of_process());
  AFTERGLOW_TRY(writer->target_, VideoTarget::open(file));
  VideoTarget& target = *writer->target_;
  auto encoder = module->encode(writer->plan_, target.out(), target.temporary(), file.string(), diagnostics);
  if (!encoder) return target.named(std::move(encoder).error());
  writer->encoder_ = std::move(*encoder);
  return writer;
}

Result<PackedFrame> VideoWriter::pack(const Picture& picture) {
  const Size size = picture.display_window.size();
  const std::string name = target_->file().string();
  if (size != plan_.size)
    return Error{ErrorKind::io,
                 fmt::format("a frame has {}x{} pixels, the first had {}x{}; a video has one size", size.width,
                             size.height, plan_.size.width, plan_.size.height),
                 name};
  std::vector<std::uint8_t> memory;
  {
    const std::lock_guard lock(mutex_);
    if (!packed_.empty()) {
      memory = std::move(packed_.back());
      packed_.pop_back();
    }
  }
  try {
    return pack_frame(picture, plan_.pack, std::move(memory));
  } catch (const std::exception& error) {
    return Error{ErrorKind::io, "cannot be written: " + exception_text(error), name};
  }
}

Result<void> VideoWriter::write(PackedFrame frame, VideoTime time) {
  try {
    if (auto written = encoder_->write(frame, time); !written) return target_->named(std::move(written).error());
    if (target_->out().failure() != 0) return target_->named({});
    const std::lock_guard lock(mutex_);
    packed_.push_back(std::move(frame.bytes));
  } catch (const std::exception& error) {
    return Error{ErrorKind::io, "cannot be written: " + exception_text(error), target_->file().string()};
  }
  return {};
}

Result<void> VideoWriter::finish(bool whole) {
  if (auto finished = encoder_->finish(whole); !finished) return target_->named(std::move(finished).error());
  return target_->commit();
}

Result<void> join_video(const fs::path& file, const VideoPlan& plan, const VideoPieces& pieces,
                        Diagnostics& diagnostics) {
  AFTERGLOW_TRY(const FfmpegModule* module, ffmpeg_module());
  AFTERGLOW_TRY(const auto target, VideoTarget::open(file));
  auto joined = module->join(plan, pieces, target->out(), target->temporary(), file.string(), diagnostics);
  if (!joined) return target->named(std::move(joined).error());
  return target->commit();
}

}  // namespace afterglow
