// SPDX-License-Identifier: MIT
// A module that was built from other headers than the program.
extern "C" const char* afterglow_module_shapes() { return "others"; }
extern "C" int afterglow_entry() { return 1; }
