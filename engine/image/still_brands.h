// SPDX-License-Identifier: MIT
// Pictures whose files are boxes as those of videos are: HEIF, AVIF and others, by the brands of their first box.
#pragma once

#include <string_view>

namespace afterglow {

/// By ISO/IEC 14496-12, 4.3: the brand that the file is made for, or one that it is compatible with.
enum class Still { none, heif, other };
/// `head`: the first bytes of a file; 400 hold every list of brands that is met. `other`: JPEG XL, JPEG 2000, Canon
/// raw.
Still still_of(std::string_view head);

}  // namespace afterglow
