// SPDX-License-Identifier: MIT
// Modules: parts of the program in shared libraries of their own, loaded when they are first needed, because what they
// link takes longer to load than most commands take to run.
#pragma once

#include <string>

#include "core/result.h"

namespace afterglow {

/// The address of `entry` in the module `name` ("afterglow_oiio.so"): beside the program or library that this code is
/// part of, in the library folder of its installation, below the prefix it was built for, or where it was built. The
/// module stays loaded. Thread-safe. Errors: io (not installed, of
/// another build, cannot be loaded; the message is about "NAME (why)").
Result<void*> load_module(const std::string& name, const char* entry);

}  // namespace afterglow
