// SPDX-License-Identifier: MIT
// Pictures one behind the other in one stream, of which readers of files would take the first alone.
#pragma once

#include <optional>
#include <string_view>

namespace afterglow {

/// The first of several pictures of one kind.
struct FirstOfSeveral {
  std::string_view kind;         ///< "PNG"
  std::string_view video = {};   ///< FFmpeg's name of such a stream, where it is read frame by frame; else ""
  std::string_view leaves = {};  ///< what that way does not read of them: "colour profile"; "": nothing
};

/// Whether another picture of the same kind begins behind the first; `bytes` may end anywhere. Kinds: PNG, JPEG, EXR,
/// TIFF, BMP, DPX, Cineon, HDR, WebP and JPEG 2000. A JPEG that says that others go with it (the gain maps and previews
/// of cameras) is one picture. Thread-safe.
std::optional<FirstOfSeveral> first_of_several(std::string_view bytes);

}  // namespace afterglow
