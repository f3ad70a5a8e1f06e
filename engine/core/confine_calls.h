// SPDX-License-Identifier: MIT
// The calls of the kernel that a confined process is left with (core/confine.h).
#pragma once

#include "core/result.h"

namespace afterglow {

/// Forbids, for good, the calls by which a process reaches others, the network, files by their names other than to
/// open, make, rename and remove them, or the kernel's less trodden parts. They fail as if the user had no right to
/// them. The process must have set no_new_privs. Errors: device (the kernel has no seccomp).
Result<void> confine_calls();

}  // namespace afterglow
