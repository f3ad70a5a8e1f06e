#include "image/picture_file.h"

#include <fmt/format.h>

#include "image/container_check.h"
#include "image/exr_file.h"
#include "image/oiio_file.h"

namespace afterglow {
namespace {

Result<std::unique_ptr<PictureFile>> open_checked_exr(const std::filesystem::path& file, const SizeLimits& limits) {
  AFTERGLOW_TRY(std::vector<ExrPart> parts, read_exr_header(file));
  for (const ExrPart& part : parts) {
    if (part.deep) continue;  // never read
    AFTERGLOW_CHECK(check_sides(part.data_window, "data window", limits, file));
    AFTERGLOW_CHECK(check_sides(part.display_window, "display window", limits, file));
    if (part.buffer_bytes(1) > limits.max_bytes)
      return Error{ErrorKind::io, fmt::format("needs {} MiB to decode, more than the {} MiB allowed (--max-memory)",
                                              part.buffer_bytes(1) >> 20, limits.max_bytes >> 20), file.string()};
  }
  return open_exr(file, std::move(parts));
}

}  // namespace

Result<void> check_sides(const Rect& window, const char* what, const SizeLimits& limits, const std::filesystem::path& file) {
  if (window.width < 1 || window.height < 1) return Error{ErrorKind::io, "has no pixels", file.string()};
  if (window.width <= limits.max_side && window.height <= limits.max_side) return {};
  return Error{ErrorKind::io, fmt::format("its {} is {}×{}, larger than {} a side", what, window.width, window.height, limits.max_side),
               file.string()};
}

Result<std::unique_ptr<PictureFile>> open_picture(const std::filesystem::path& file, const SizeLimits& limits) {
  AFTERGLOW_TRY(const ContainerFacts container, check_container(file));
  if (container.kind == ContainerFacts::Kind::exr) return open_checked_exr(file, limits);
  if (container.kind == ContainerFacts::Kind::png || container.kind == ContainerFacts::Kind::jpeg)
    AFTERGLOW_CHECK(check_sides({0, 0, container.size.width, container.size.height}, "picture", limits, file));
  return open_with_oiio(file, container, limits);
}

}  // namespace afterglow
