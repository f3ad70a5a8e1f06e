#include "image/picture_file.h"

#include <fmt/format.h>

#include "image/container_check.h"
#include "image/exr_file.h"
#include "image/movie.h"
#include "image/oiio_module.h"

namespace afterglow {
namespace {

Result<std::unique_ptr<PictureFile>> open_checked_exr(const std::filesystem::path& file, const SizeLimits& limits) {
  AFTERGLOW_TRY(std::vector<ExrPart> parts, read_exr_header(file));
  for (const ExrPart& part : parts) {
    if (part.deep) continue;  // never read
    AFTERGLOW_CHECK(check_sides(part.data_window, "data window", limits, file));
    AFTERGLOW_CHECK(check_sides(part.display_window, "display window", limits, file));
    if (part.buffer_bytes(1) > limits.max_bytes)
      return Error{ErrorKind::io,
                   fmt::format("needs {} MiB to decode, more than the {} MiB allowed (--max-memory)",
                               part.buffer_bytes(1) >> 20, limits.max_bytes >> 20),
                   file.string()};
  }
  std::uint64_t least = 0;
  for (const ExrPart& part : parts) least += part.least_file_bytes();
  std::error_code ec;
  if (const std::uint64_t size = std::filesystem::file_size(file, ec); !ec && size < least)
    return Error{ErrorKind::io, fmt::format("is truncated: {} bytes cannot hold its pixels", size), file.string()};
  return open_exr(file, std::move(parts));
}

}  // namespace

Result<std::unique_ptr<PictureFile>> open_picture(const std::filesystem::path& file, const SizeLimits& limits) {
  AFTERGLOW_TRY(const ContainerFacts container, check_container(file));
  if (container.kind == ContainerFacts::Kind::exr) return open_checked_exr(file, limits);
  if (container.kind == ContainerFacts::Kind::png || container.kind == ContainerFacts::Kind::jpeg)
    AFTERGLOW_CHECK(check_sides({0, 0, container.size.width, container.size.height}, "picture", limits, file));
  if (container.kind == ContainerFacts::Kind::png) {
    // A bit a pixel at least, and deflate gains 1032 at most.
    const std::uint64_t least = static_cast<std::uint64_t>(container.size.area()) / 8 / 1100;
    std::error_code ec;
    if (const std::uint64_t size = std::filesystem::file_size(file, ec); !ec && size < least)
      return Error{ErrorKind::io, fmt::format("is truncated: {} bytes cannot hold its pixels", size), file.string()};
  }
  const char* container_name = nullptr;
  if (container.kind == ContainerFacts::Kind::other &&
      movie_container(file, &container_name) == MovieContainer::unreadable_movie)
    return Error{ErrorKind::io,
                 fmt::format("is a video in a container that is not read ({}); `ffmpeg -i {} -c copy {}` puts it into "
                             "one that is",
                             container_name, file.filename().string(),
                             std::filesystem::path(file.filename()).replace_extension(".mp4").string()),
                 file.string(), 0, "MP4, QuickTime, AVI"};
  const auto module = oiio_module();
  if (!module) return Error{ErrorKind::io, module.error().message, file.string()};
  return module.value()->open(file, container, limits);
}

}  // namespace afterglow
