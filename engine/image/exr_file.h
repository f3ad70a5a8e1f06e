// SPDX-License-Identifier: MIT
// OpenEXR files, through OpenEXR itself: it decodes straight into the caller's floats, keeps every attribute, and knows
// luminance-chroma and deep files, which OpenImageIO 2.4 does not.
#pragma once

#include <memory>
#include <vector>

#include "image/exr_header.h"
#include "image/picture_file.h"

namespace afterglow {

/// `header` as read_exr_header found it in `file`.
Result<std::unique_ptr<PictureFile>> open_exr(const std::filesystem::path& file, std::vector<ExrPart> header);

/// OpenEXR decodes and encodes on a thread pool of the process. If nobody has given it threads, it gets one for each
/// core (16 at most); a count that the program has chosen is left alone.
void use_exr_threads();

}  // namespace afterglow
