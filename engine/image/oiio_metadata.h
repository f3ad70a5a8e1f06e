// SPDX-License-Identifier: MIT
// Metadata between OpenImageIO's lists and the general form.
#pragma once

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/paramlist.h>

#include <cstdint>
#include <span>
#include <vector>

#include "image/metadata.h"

namespace afterglow {

Metadata metadata_of(const OIIO::ParamValueList& list);
/// Of a JPEG: where the two resolutions are dots in an inch or a centimetre, a pixel's shape is that of their
/// distances. OpenImageIO 2.4 takes them for its width and height, as they are without a unit.
void correct_jpeg_shape(Metadata& metadata);

/// What a block of EXIF says, which has been checked (metadata_check.h); empty: nothing.
void add_exif(std::span<const std::uint8_t> exif, OIIO::ImageSpec& spec);

/// A block of EXIF of what the list says; empty where it says nothing that EXIF has.
std::vector<char> exif_of(const OIIO::ParamValueList& list);

OIIO::ParamValueList param_list(const Metadata& metadata);

}  // namespace afterglow
