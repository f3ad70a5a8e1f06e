// Ctrl-C and SIGTERM as a flag: work stops between its steps, so that nothing half-written is left.
#pragma once

#include "core/result.h"

namespace afterglow {

/// The first SIGINT or SIGTERM sets a flag; the second ends the process at once. A file that grows
/// beyond the limit of the process (SIGXFSZ) is an error of its writer instead of the end of the process.
void install_interrupt_handler();
bool interrupted();
/// What commands return once `interrupted()` is true; exit code 130.
Error interrupt_error();

}  // namespace afterglow
