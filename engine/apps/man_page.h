// SPDX-License-Identifier: MIT
// Manual pages (man(7)), from the declarations of the commands.
#pragma once

#include <string>
#include <vector>

#include "apps/command_words.h"

namespace afterglow {

/// afterglow(1): what there is. `footer`: of the program's own help.
std::string program_page(const std::vector<CommandWords>& commands, const std::string& help, const std::string& footer);
/// afterglow-COMMAND(1).
std::string command_page(const CommandWords& command);

}  // namespace afterglow
