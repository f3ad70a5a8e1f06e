// SPDX-License-Identifier: MIT
// Of which commit the program was built.
#pragma once

namespace afterglow {

/// "1a2b3c4d5e6f", with "+changes" when it had others; empty: built of no checkout.
const char* commit();

}  // namespace afterglow
