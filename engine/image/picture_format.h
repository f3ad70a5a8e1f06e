// SPDX-License-Identifier: MIT
// Which of OpenImageIO's readers a file is given to. Left to itself it tries all that it has, those of old and odd
// formats too, whose parsers were never written for files of strangers; FFmpeg among them follows playlists to other
// files, and that of Photoshop's layers takes whatever memory 500 bytes ask for before anyone can look. So the content
// names the reader, and what no name is known for is not read.
#pragma once

#include <filesystem>
#include <string>

namespace afterglow {

/// OpenImageIO's name of the format ("tiff", "hdr"), by the first bytes; Targa, which begins with nothing of its own,
/// by its last bytes or the name's extension. Empty: none that is read.
std::string picture_format(const std::filesystem::path& file);

/// What messages say is allowed.
inline constexpr const char* kPictureFormats =
    "EXR, PNG, JPEG, TIFF, Radiance HDR, PNM and PFM, DPX, Cineon, Targa, BMP, WebP, JPEG 2000, HEIF and AVIF, SGI, "
    "GIF; "
    "videos: MP4, QuickTime, Matroska, WebM, AVI, MXF, MPEG streams, Y4M, animated GIF, PNG and WebP";

}  // namespace afterglow
