// SPDX-License-Identifier: MIT
// The IPTC block of a JPEG that OpenImageIO has made. Internal to the room.
#pragma once

#include <cstdint>
#include <vector>

namespace afterglow {

/// Its texts are UTF-8, but only this says so: the record 1:90 (CodedCharacterSet) is put before the others where one
/// of them has letters beyond ASCII. Whatever else the bytes are, they stay.
void tell_iptc_letters(std::vector<std::uint8_t>& jpeg);

}  // namespace afterglow
