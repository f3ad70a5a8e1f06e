// SPDX-License-Identifier: MIT
// The commands and their options as plain data, read from their own declarations: what completions and manual pages are
// made of.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace afterglow {

struct OptionWords {
  std::vector<std::string> names;  ///< "-o", "--output"; of a positional: its name alone
  std::string help, group;
  std::string value;                 ///< "FILE"; empty: a flag
  std::vector<std::string> choices;  ///< all values that it takes, when they are few
  std::vector<std::string> usual;    ///< some of those that it takes, else
  bool settings = false;             ///< it takes ENTRY.SETTING=VALUE: `completion --settings` says which there are
  bool positional = false, required = false;
};

struct CommandWords {
  std::string name, help, footer;
  std::vector<OptionWords> options;  ///< positionals first
};

std::vector<CommandWords> command_words(const CLI::App& program);

}  // namespace afterglow
