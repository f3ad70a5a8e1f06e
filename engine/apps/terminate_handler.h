// SPDX-License-Identifier: MIT
// What the program says when it has to end where nothing can be caught.
#pragma once

namespace afterglow {

/// From here on std::terminate writes one line, "error: out of memory" or "error: internal error: …", and ends the
/// process with the exit code that such an error has elsewhere (4, 1). Libraries take memory in destructors and other
/// functions that may not throw: nlohmann::json to destroy what it holds, CLI11 to look at names, libstdc++ to
/// list folders. Takes the place of the handlers of std::set_terminate and std::set_new_handler.
void install_last_words();

}  // namespace afterglow
