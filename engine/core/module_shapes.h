// SPDX-License-Identifier: MIT
// Modules and the program pass each other C++ objects: both have to be built from the same headers. An update beneath a
// program that runs, or a build that was stopped half way, leaves others.
#pragma once

namespace afterglow {

/// A hash of all headers that the program shares with its modules; each has its own.
__attribute__((visibility("hidden"))) const char* module_shapes();

}  // namespace afterglow

/// Once in each module: what it was built from, for load_module.
#define AFTERGLOW_MODULE_SHAPES                                                             \
  extern "C" __attribute__((visibility("default"))) const char* afterglow_module_shapes() { \
    return afterglow::module_shapes();                                                      \
  }
