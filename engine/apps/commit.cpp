// SPDX-License-Identifier: MIT
#include "apps/commit.h"

#include "commit_text.h"

namespace afterglow {

const char* commit() { return AFTERGLOW_COMMIT; }

}  // namespace afterglow
