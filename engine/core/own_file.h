// SPDX-License-Identifier: MIT
// Where this code lies.
#pragma once

#include <filesystem>

namespace afterglow {

/// The program or shared library that this code is part of, with links resolved: what it needs at run time is found
/// from there. Empty where the system does not tell. Asked once: the answer waits while a library is being loaded.
/// Thread-safe.
std::filesystem::path own_file();

/// Whether that is in the folder it was built in: then the sources are at hand.
bool is_in_build_folder();

}  // namespace afterglow
