// SPDX-License-Identifier: MIT
// Completion of commands, options and their values in shells.
#pragma once

#include <string>
#include <vector>

#include "apps/command_words.h"

namespace afterglow {

std::string bash_completion(const std::vector<CommandWords>& commands);
std::string zsh_completion(const std::vector<CommandWords>& commands);
std::string fish_completion(const std::vector<CommandWords>& commands);

}  // namespace afterglow
