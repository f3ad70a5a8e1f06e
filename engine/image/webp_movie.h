// SPDX-License-Identifier: MIT
// Animated WebP, which FFmpeg does not read: what OiioModule has for movie.h.
#pragma once

#include <memory>

#include "image/movie_source.h"

namespace afterglow {

/// The file is read into memory. Errors: io (damaged, larger than the limits).
Result<std::shared_ptr<MovieSource>> open_webp_movie(const MovieRequest& request);

}  // namespace afterglow
