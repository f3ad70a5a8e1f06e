// SPDX-License-Identifier: MIT
#include "image/picture_file.h"

#include <fmt/format.h>

#include "core/memory_limit.h"
#include "core/parallel.h"
#include "core/saturated.h"
#include "core/text.h"
#include "image/container_check.h"
#include "image/exr_file.h"
#include "image/movie.h"
#include "image/oiio_module.h"
#include "image/picture_format.h"

namespace afterglow {
namespace {

/// A file that claims more pixels than its bytes can hold is refused before memory is taken for them.
Result<void> check_room(const std::filesystem::path& file, std::uint64_t least) {
  std::error_code ec;
  const std::uint64_t size = std::filesystem::file_size(file, ec);
  if (ec || size >= least) return {};
  return Error{ErrorKind::io, fmt::format("is truncated: {} bytes cannot hold its pixels", size), file.string()};
}

/// So is one that makes its decoder take more memory than allowed.
Result<void> check_decoder(const std::filesystem::path& file, std::uint64_t bytes, const SizeLimits& limits) {
  if (bytes <= limits.max_bytes) return {};
  return Error{
      ErrorKind::io,
      fmt::format("needs {} to decode, more than the {}", needed_memory(bytes), allowed_memory(limits.max_bytes)),
      file.string()};
}

Result<std::unique_ptr<PictureFile>> open_checked_exr(const std::filesystem::path& file, const SizeLimits& limits) {
  AFTERGLOW_TRY(std::vector<ExrPart> parts, read_exr_header(file));
  for (const ExrPart& part : parts) {
    if (part.deep) continue;  // never read
    AFTERGLOW_CHECK(check_sides(part.data_window, "data window", limits, file));
    AFTERGLOW_CHECK(check_sides(part.display_window, "display window", limits, file));
    AFTERGLOW_CHECK(check_decoder(file, part.buffer_bytes(1), limits));
  }
  std::uint64_t least = 0;
  for (const ExrPart& part : parts) least = saturated_sum({least, part.least_file_bytes()});
  AFTERGLOW_CHECK(check_room(file, least));
  return open_exr(file, std::move(parts));
}

}  // namespace

Result<void> PictureFile::read(int part, std::span<const ReadTarget> targets, const RowsArrived& rows) {
  AFTERGLOW_TRY(const bool told, read_targets(part, targets, rows));
  if (told || !rows) return {};
  const Size size = parts_[static_cast<std::size_t>(part)].data_window.size();
  parallel_rows(size.height, static_cast<long long>(size.area()) * static_cast<long long>(targets.size()), rows);
  return {};
}

Result<std::unique_ptr<PictureFile>> open_picture(const std::filesystem::path& file, const SizeLimits& limits) {
  AFTERGLOW_TRY(const ContainerFacts container, check_container(file));
  if (container.kind == ContainerFacts::Kind::exr) return open_checked_exr(file, limits);
  if (container.size)
    AFTERGLOW_CHECK(check_sides({0, 0, container.size->width, container.size->height}, "picture", limits, file));
  AFTERGLOW_CHECK(check_decoder(file, container.decoder_bytes, limits));
  AFTERGLOW_CHECK(check_room(file, container.least_file_bytes));
  if (container.kind != ContainerFacts::Kind::jpeg && !movie_format(file).empty()) {
    Diagnostics quiet;  // whoever wants to know opens the movie
    AFTERGLOW_TRY(auto movie, Movie::open(file, limits, quiet, &container));
    return Movie::frame(std::move(movie), 0);
  }
  const std::string format = picture_format(file);
  if (format.empty())
    return Error{ErrorKind::io, "is not a picture in a format that is known", file.string(), 0, kPictureFormats};
  const auto module = oiio_module();
  if (!module) return Error{ErrorKind::io, module.error().message, file.string()};
  return module.value()->open(file, format, container, limits);
}

}  // namespace afterglow
