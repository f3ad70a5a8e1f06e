// SPDX-License-Identifier: MIT
#include "core/version.h"

namespace afterglow {

const char* version() { return AFTERGLOW_VERSION; }

}  // namespace afterglow
