// SPDX-License-Identifier: MIT
// Which Afterglow this is.
#pragma once

namespace afterglow {

/// "0.2.0", as CMake's project() says.
const char* version();

}  // namespace afterglow
