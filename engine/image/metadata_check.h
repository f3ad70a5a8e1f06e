// SPDX-License-Identifier: MIT
// Metadata inside of pictures with which OpenImageIO 2.4 reads beyond its memory or runs out of stack. Each function
// says what is wrong, or null. What it leaves out with a word of its own is not wrong here. Internal to the room.
#pragma once

#include <optional>
#include <span>

namespace afterglow {

using Bytes = std::span<const unsigned char>;

/// From the TIFF header on, or from the "Exif\0\0" before it.
const char* exif_fault(Bytes exif);
/// The orientation that it says, 1 to 8. None: it says none, or another number.
std::optional<int> exif_orientation(Bytes exif);
/// Whether it says that its picture is Adobe RGB: R03 of DCF 2.0, which cameras write in place of a profile.
bool exif_says_adobe_rgb(Bytes exif);
/// A whole profile.
const char* icc_fault(Bytes profile);
/// A text that may hold rdf:Description elements.
const char* xmp_fault(Bytes xml);

}  // namespace afterglow
