// SPDX-License-Identifier: MIT
// Ctrl-C, SIGTERM, SIGHUP and SIGXCPU as a flag: work stops between its steps, so that nothing half-written is left.
#pragma once

#include "core/result.h"

namespace afterglow {

/// The first SIGINT, SIGTERM, SIGHUP or SIGXCPU (`ulimit -t`) that the parent has not ignored sets a flag; the second,
/// or a second that passes (a driver may not let go for minutes), ends the process with exit code 130, its temporary
/// files removed. A file that grows beyond the limit of the process (SIGXFSZ) and a pipe that nobody reads (SIGPIPE)
/// are errors of whoever writes instead of the end of the process.
void install_interrupt_handler();
/// How many seconds the work has to end, once it was asked to, before the process is ended: 1 unless it is said.
void allow_to_end(unsigned seconds);

bool interrupted();
/// What commands return once `interrupted()` is true; exit code 130.
Error interrupt_error();

}  // namespace afterglow
