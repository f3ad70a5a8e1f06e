// SPDX-License-Identifier: MIT
// Writes WebP by libwebp: OpenImageIO 2.4 writes it lossy alone.
#pragma once

#include <span>

#include "image/output_file.h"
#include "image/strips.h"

namespace afterglow {

/// The display window as 8-bit RGB or straight RGBA, lossless, or lossy with a `quality` of 0 to 100, with this block
/// of EXIF unless it is empty. Errors: io (sides above 16383, memory); failures of the file are found in `out`.
Result<void> write_webp(const Picture& picture, const StripForm& form, OutputFile& out, std::optional<float> quality,
                        std::span<const char> exif);

}  // namespace afterglow
