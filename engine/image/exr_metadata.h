// Metadata between OpenEXR's attributes and OpenImageIO's names, so that it survives a change of format.
#pragma once

#include <OpenEXR/ImfHeader.h>
#include <OpenImageIO/paramlist.h>

namespace afterglow {

/// All attributes of simple types, under OpenImageIO's names ("comments" → "ImageDescription").
OIIO::ParamValueList metadata_of(const Imf::Header& header);

/// Adds metadata under the names that OpenEXR gives it; values of types that have no attribute are left out.
void add_metadata(Imf::Header& header, const OIIO::ParamValueList& metadata);

}  // namespace afterglow
