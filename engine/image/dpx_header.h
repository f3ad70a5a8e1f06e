// SPDX-License-Identifier: MIT
// What the library leaves to be said in the headers of DPX files. Internal to the room.
#pragma once

#include <cstddef>
#include <string>

#include "image/output_file.h"
#include "image/picture.h"

namespace afterglow {

/// Where 4 bytes tell how many lie behind each line (end-of-line padding of the first element).
constexpr std::size_t kDpxLinePaddingAt = 812;

/// The name of the file, in place of that which it has while it is written, and no time of creation where the picture
/// has none: the same picture is the same bytes. (SMPTE 268M, file information header.)
void set_dpx_name_and_time(const Picture& picture, const std::string& name, OutputFile& out);

/// Lines of whole words of 32 bits, as the standard has them, where the library has put line to line.
void pad_dpx_lines(OutputFile& out);

}  // namespace afterglow
