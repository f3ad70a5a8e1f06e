// SPDX-License-Identifier: MIT
// Primaries of the light that EXR files hold, read and written.
#pragma once

#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfHeader.h>

#include <optional>

#include "image/color_matrix.h"
#include "image/picture.h"
#include "image/writer.h"

namespace afterglow {

/// What the header says; of one that says nothing Rec.709.
Chromaticities chromaticities_of(const Imf::Header& header);
/// The same, where it is neither Rec.709 (rounded numbers count as that) nor nonsense.
std::optional<Chromaticities> own_primaries(const Imf::Header& header);
/// As an attribute has them.
Imf::Chromaticities exr_chromaticities(const Chromaticities& primaries);

/// Primaries that the colours of a new EXR get in place of Rec.709: those of --output-space, or, beside layers that are
/// kept, those that the file has.
std::optional<Chromaticities> written_primaries(const Picture& picture, const WriteOptions& options);
/// The same picture with its colours in these primaries, as floats. Colours, windows and facts alone.
Picture in_primaries(const Picture& picture, const Chromaticities& primaries);

}  // namespace afterglow
