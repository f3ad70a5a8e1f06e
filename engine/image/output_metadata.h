// SPDX-License-Identifier: MIT
// Which metadata of the input a new file keeps: everything but what described the old file.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <string_view>

#include "image/metadata.h"

namespace afterglow {

/// Whether an attribute says something about the picture, not about how the old file stored it (compression, tiling,
/// orientation, profile, chromaticities, names of parts and channels, thumbnails).
bool keeps_metadata(std::string_view name);

/// What is kept.
Metadata kept_metadata(const FileFacts& facts);

/// Adds what is kept to a new EXR header: attributes as they were when the input was EXR, converted ones else.
void add_kept_attributes(Imf::Header& header, const FileFacts& facts);

}  // namespace afterglow
