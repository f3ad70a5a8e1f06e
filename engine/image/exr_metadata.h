// SPDX-License-Identifier: MIT
// Metadata between OpenEXR's attributes and the general form, so that it survives a change of format.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include "image/metadata.h"

namespace afterglow {

/// All attributes of simple types; EXR's own names become general ones ("comments" → "ImageDescription").
Metadata metadata_of(const Imf::Header& header);

/// Adds metadata under the names that OpenEXR gives it; values of types that have no attribute are left out.
void add_metadata(Imf::Header& header, const Metadata& metadata);

}  // namespace afterglow
