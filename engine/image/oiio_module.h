// SPDX-License-Identifier: MIT
// OpenImageIO, at arm's length. Debian's build of it draws in some 250 shared libraries, which take longer to load than
// a frame takes to read; they are loaded when the first file comes that is neither EXR (read and written) nor PNG
// (written), or when pictures are compared as people see them.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "image/container_check.h"
#include "image/image.h"
#include "image/movie_source.h"
#include "image/output_file.h"
#include "image/output_format.h"
#include "image/picture_file.h"

namespace afterglow {

struct OiioModule {
  /// With the reader of that name alone: see picture_format.h.
  Result<std::unique_ptr<PictureFile>> (*open)(const std::filesystem::path& file, const std::string& format,
                                               const ContainerFacts& container, const SizeLimits& limits);
  /// See oiio_write.h; `name` is for messages.
  Result<void> (*write)(const Picture& picture, const OutputFormat& format, OutputFile& out, const std::string& name,
                        const WriteOptions& options);
  /// See webp_movie.h.
  Result<std::shared_ptr<MovieSource>> (*open_webp)(const MovieRequest& request);
  /// See metrics.h.
  Result<double> (*visible_difference)(const Image& a, const Image& b);
};

/// Loads it on the first call; thread-safe. Errors: io (not installed).
Result<const OiioModule*> oiio_module();

}  // namespace afterglow
