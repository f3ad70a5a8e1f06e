// SPDX-License-Identifier: MIT
#include "image/ffmpeg_bytes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace afterglow {
namespace {

constexpr int kIoBuffer = 1 << 18;

/// Playlists, external tracks and the like would read other files.
int refuse_other_files(AVFormatContext*, AVIOContext**, const char*, int, AVDictionary**) { return AVERROR(EPERM); }

}  // namespace

Result<std::unique_ptr<FfmpegBytes>> FfmpegBytes::open(const std::filesystem::path& file, const Patience& patience) {
  auto descriptor = std::make_shared<FileDescriptor>(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (descriptor->get() < 0)
    return Error{ErrorKind::io, fmt::format("cannot be opened: {}", std::strerror(errno)), file.string()};
  // Who seeks reads some bytes twice; nobody needs to read all of them many times before the next packet.
  constexpr std::uint64_t kTurns = 4, kLeast = 64 << 20;
  struct stat status {};
  const bool known = fstat(descriptor->get(), &status) == 0 && status.st_size > 0;
  const std::uint64_t most = kLeast + (known ? kTurns * static_cast<std::uint64_t>(status.st_size) : 0);
  auto bytes =
      std::make_unique<FfmpegBytes>(std::make_unique<PatientReader>(std::move(descriptor), patience), "", most);
  bytes->seekable_ = true;
  return bytes;
}

FfmpegBytes::FfmpegBytes(std::unique_ptr<PatientReader> reader, std::string head, std::uint64_t most)
    : reader_(std::move(reader)), head_(std::move(head)), most_(most) {}

FfmpegBytes::~FfmpegBytes() {
  if (io_) av_freep(&io_->buffer);
  avio_context_free(&io_);
}

AVFormatContext* FfmpegBytes::container() {
  auto* buffer = static_cast<std::uint8_t*>(av_malloc(kIoBuffer));
  io_ = buffer ? avio_alloc_context(buffer, kIoBuffer, 0, this, read, nullptr, seekable_ ? seek : nullptr) : nullptr;
  if (!io_) {
    av_free(buffer);
    return nullptr;
  }
  AVFormatContext* container = avformat_alloc_context();
  if (!container) return nullptr;
  container->pb = io_;
  container->io_open = refuse_other_files;
  container->flags |= AVFMT_FLAG_CUSTOM_IO;
  // Loops of FFmpeg that read nothing hear of it too.
  container->interrupt_callback = {
      .callback = [](void* opaque) { return static_cast<const FfmpegBytes*>(opaque)->given_up_ ? 1 : 0; },
      .opaque = this};
  return container;
}

int FfmpegBytes::read(void* opaque, std::uint8_t* to, int size) {
  FfmpegBytes& bytes = *static_cast<FfmpegBytes*>(opaque);
  if (bytes.given_ < bytes.head_.size()) {
    const std::size_t count = std::min(bytes.head_.size() - bytes.given_, static_cast<std::size_t>(size));
    std::memcpy(to, bytes.head_.data() + bytes.given_, count);
    bytes.given_ += count;
    bytes.note(to, count);
    return static_cast<int>(count);
  }
  if (bytes.given_up_) return AVERROR_EXIT;
  const auto got = bytes.reader_->read(to, static_cast<std::size_t>(size));
  if (!got) {
    bytes.given_up_ = got.error();
    return AVERROR_EXIT;
  }
  // A look at the end counts too: nobody may look there for ever.
  constexpr std::uint64_t kLeast = 4096;
  bytes.spent_ += std::max<std::uint64_t>(*got, kLeast);
  if (bytes.spent_ > bytes.most_) {
    bytes.given_up_ = Error{ErrorKind::io, fmt::format("has no frame within {} MiB that were read", bytes.most_ >> 20)};
    return AVERROR_EXIT;
  }
  bytes.at_end_ = *got == 0;
  bytes.note(to, *got);
  return *got > 0 ? static_cast<int>(*got) : AVERROR_EOF;
}

/// Of what passes by, the beginning and the end are kept.
void FfmpegBytes::note(const std::uint8_t* bytes, std::size_t count) {
  constexpr std::size_t kFirst = 4096, kLast = 1 << 16;
  if (seekable_) return;
  const auto* text = reinterpret_cast<const char*>(bytes);
  all_ += count;
  first_.append(text, std::min(count, kFirst - first_.size()));
  const std::size_t kept = std::min(count, kLast);
  if (last_.size() + kept > kLast) last_.erase(0, last_.size() + kept - kLast);
  last_.append(text + (count - kept), kept);
}

PlacedBytes FfmpegBytes::again() {
  struct stat status {};
  const bool known = seekable_ && fstat(reader_->descriptor(), &status) == 0 && status.st_size > 0;
  return {.size = known ? static_cast<std::uint64_t>(status.st_size) : all_,
          .look = [this](std::uint64_t at, std::size_t count) { return look(at, count); }};
}

std::string_view FfmpegBytes::look(std::uint64_t at, std::size_t count) {
  const auto part = [&](const std::string& kept, std::uint64_t begin) {
    return at < begin || at - begin > kept.size() ? std::string_view()
                                                  : std::string_view(kept).substr(at - begin, count);
  };
  if (!seekable_) {
    const std::string_view first = part(first_, 0);
    return first.size() == count ? first : part(last_, all_ - last_.size());
  }
  if (const std::string_view kept = part(window_, window_at_); kept.size() == count) return kept;
  constexpr std::size_t kWindow = 4096;
  // FFmpeg goes on where it was.
  const int descriptor = given_up_ ? -1 : reader_->descriptor();
  const off_t before = lseek(descriptor, 0, SEEK_CUR);
  window_.assign(std::max(count, kWindow), '\0');
  window_at_ = at;
  std::size_t have = 0;
  for (bool more = lseek(descriptor, static_cast<off_t>(at), SEEK_SET) >= 0; more && have < count;) {
    const auto got = reader_->read(window_.data() + have, window_.size() - have);
    if (!got) given_up_ = got.error();
    more = got && *got > 0;
    have += more ? *got : 0;
  }
  window_.resize(have);
  if (!given_up_) lseek(descriptor, before, SEEK_SET);
  return part(window_, window_at_);
}

std::int64_t FfmpegBytes::seek(void* opaque, std::int64_t to, int whence) {
  const FfmpegBytes& bytes = *static_cast<const FfmpegBytes*>(opaque);
  if (bytes.given_up_) return AVERROR_EXIT;
  const int descriptor = bytes.reader_->descriptor();
  if ((whence & AVSEEK_SIZE) != 0) {
    struct stat status {};
    return fstat(descriptor, &status) == 0 ? status.st_size : AVERROR(errno);
  }
  const off_t at = lseek(descriptor, to, whence & ~AVSEEK_FORCE);
  return at < 0 ? AVERROR(errno) : at;
}

}  // namespace afterglow
