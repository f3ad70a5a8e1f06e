// SPDX-License-Identifier: MIT
// Text that an editor saved in another encoding than all here reads.
#pragma once

#include <string_view>

namespace afterglow {

/// Whether a text is UTF-16: by its mark, or because it begins with ASCII of which every other byte is zero.
bool is_utf16(std::string_view text);

/// What to say of one.
constexpr const char* kUtf16 = "is UTF-16; save it as UTF-8";

}  // namespace afterglow
