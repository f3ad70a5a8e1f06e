// SPDX-License-Identifier: MIT
// Threads that work beside what somebody waits for.
#pragma once

namespace afterglow {

/// From now on this thread, and those that it starts, give way to whatever else wants the processor; nobody helps with
/// its loops. A priority that cannot be lowered is no error.
void give_way();

}  // namespace afterglow
