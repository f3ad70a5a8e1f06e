// SPDX-License-Identifier: MIT
#include "image/ffmpeg_output.h"

#include <cerrno>
#include <cstdio>

#include "image/ffmpeg_log.h"

namespace afterglow {
namespace {

constexpr int kIoBytes = 1 << 18;

#if LIBAVFORMAT_VERSION_MAJOR >= 61
using IoBytes = const std::uint8_t*;
#else
using IoBytes = std::uint8_t*;
#endif

int write_bytes(void* opaque, IoBytes bytes, int size) {
  auto& out = *static_cast<OutputFile*>(opaque);
  return out.write(bytes, static_cast<std::size_t>(size)) ? size : AVERROR(out.failure());
}

std::int64_t seek_output(void* opaque, std::int64_t to, int whence) {
  auto& out = *static_cast<OutputFile*>(opaque);
  if ((whence & AVSEEK_SIZE) != 0) return static_cast<std::int64_t>(out.size());
  const auto position = static_cast<std::int64_t>(out.position()), size = static_cast<std::int64_t>(out.size());
  const std::int64_t at = whence == SEEK_CUR ? position + to : whence == SEEK_END ? size + to : to;
  if (at < 0) return AVERROR(EINVAL);
  out.seek(static_cast<std::uint64_t>(at));
  return at;
}

Error output_failed(int code) { return {ErrorKind::io, "cannot be written: " + ffmpeg_error(code)}; }

}  // namespace

Result<std::unique_ptr<FfmpegOutput>> FfmpegOutput::open(const char* muxer, OutputFile& out,
                                                         const std::filesystem::path& path) {
  std::unique_ptr<FfmpegOutput> output(new FfmpegOutput(out, path));
  if (const int code = avformat_alloc_output_context2(&output->container_, nullptr, muxer, path.c_str()); code < 0)
    return output_failed(code);
  auto* buffer = static_cast<unsigned char*>(av_malloc(kIoBytes));
  AVFormatContext& container = *output->container_;
  container.pb = avio_alloc_context(buffer, kIoBytes, 1, &out, nullptr, write_bytes, seek_output);
  if (!container.pb) return output_failed(AVERROR(ENOMEM));
  container.flags |= AVFMT_FLAG_CUSTOM_IO | AVFMT_FLAG_BITEXACT;  // no version, no time of day: same frames, same file
  container.opaque = output.get();
  container.io_open = &FfmpegOutput::open_again;
  return output;
}

/// MP4 moves its index before its data at the end, and reads the file for that.
int FfmpegOutput::open_again(AVFormatContext* container, AVIOContext** io, const char*, int flags, AVDictionary**) {
  auto& own = *static_cast<FfmpegOutput*>(container->opaque);
  if ((flags & AVIO_FLAG_WRITE) != 0) return AVERROR(EPERM);
  if (!own.out_.flush()) return AVERROR(own.out_.failure());
  return avio_open2(io, ("file:" + own.path_.string()).c_str(), AVIO_FLAG_READ, nullptr, nullptr);
}

FfmpegOutput::~FfmpegOutput() {
  if (!container_) return;
  if (container_->pb) {
    av_freep(&container_->pb->buffer);
    avio_context_free(&container_->pb);
  }
  avformat_free_context(container_);
}

Result<void> FfmpegOutput::begin(AVDictionary** options) {
  const int code = avformat_write_header(container_, options);
  return code < 0 ? Result<void>(output_failed(code)) : Result<void>();
}

Result<void> FfmpegOutput::write(AVPacket& packet) {
  const int code = av_interleaved_write_frame(container_, &packet);
  return code < 0 ? Result<void>(output_failed(code)) : Result<void>();
}

Result<void> FfmpegOutput::finish() {
  if (const int code = av_write_trailer(container_); code < 0) return output_failed(code);
  avio_flush(container_->pb);
  return container_->pb->error < 0 ? Result<void>(output_failed(container_->pb->error)) : Result<void>();
}

}  // namespace afterglow
