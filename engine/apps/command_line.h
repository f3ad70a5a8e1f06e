// SPDX-License-Identifier: MIT
// The program: finds the command, parses its options, turns every failure into one line and an exit code.
#pragma once

namespace afterglow {

/// What `main` returns: 0 done, 2 usage, 3 preset or script, 4 input or output, 5 device, 130 interrupted, 1 anything
/// else.
int run_command_line(int argc, char** argv);

/// What `main` would return when nothing were run: 2 for arguments that are wrong, which are told on stderr; else 0.
int check_command_line(int argc, char** argv);

}  // namespace afterglow
