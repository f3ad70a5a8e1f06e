// SPDX-License-Identifier: MIT
// `run --sandbox`: what is left to a process that reads strangers' pictures.
#pragma once

#include "apps/run_arguments.h"
#include "core/confine.h"

namespace afterglow {

/// The pictures themselves, the folders of the look, the installation, drivers and libraries to read; the folders of
/// outputs and reports to write; caches to read alone, so that nothing stays for the next run. Errors: script (no such
/// preset).
Result<Confinement> sandbox_of(const RunArguments& arguments);

}  // namespace afterglow
