// SPDX-License-Identifier: MIT
// `afterglow completion` and `afterglow man`: what shells and `man` know of the program, from its own declarations.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "apps/command.h"
#include "apps/completion_script.h"
#include "apps/man_page.h"
#include "apps/output.h"
#include "apps/usual_words.h"
#include "core/text.h"

namespace afterglow {
namespace {

Result<void> print_page(const CLI::App& program, const std::string& name) {
  const auto commands = command_words(program);
  if (name.empty()) {
    output("{}", program_page(commands, program.get_description(), program.get_footer()));
    return {};
  }
  const auto found = std::ranges::find(commands, name, &CommandWords::name);
  if (found == commands.end()) {
    std::vector<std::string> names;
    for (const auto& command : commands) names.push_back(command.name);
    return Error{ErrorKind::usage, fmt::format("there is no command '{}'", name),
                 "afterglow man",  0,
                 join(names),      nearest_name(name, names)};
  }
  output("{}", command_page(*found));
  return {};
}

}  // namespace

Command add_completion_command(CLI::App& program) {
  auto* app = program.add_subcommand("completion", "Print what a shell needs to complete commands and options");
  auto shell = std::make_shared<std::string>();
  app->add_option("SHELL", *shell, "bash, zsh or fish")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
  auto settings = std::make_shared<bool>(false);
  auto words = std::make_shared<std::vector<std::string>>();
  app->add_flag("--settings", *settings, "What the script asks where settings are set")->group("");
  app->add_option("WORDS", *words, "With it: those on the line, behind --")->group("");
  app->footer("Example: afterglow completion bash > ~/.local/share/bash-completion/completions/afterglow");
  return {app, [shell, settings, words, &program](Console&) -> Result<void> {
            if (*settings) {
              for (const auto& word : setting_words(*words)) output("{}\n", word);
              return {};
            }
            const auto commands = command_words(program);
            output("{}", *shell == "bash"  ? bash_completion(commands)
                         : *shell == "zsh" ? zsh_completion(commands)
                                           : fish_completion(commands));
            return {};
          }};
}

Command add_man_command(CLI::App& program) {
  auto* app = program.add_subcommand("man", "Print the manual page of the program or of a command");
  auto name = std::make_shared<std::string>();
  app->add_option("COMMAND", *name, "Command to print the page of (default: the program)");
  app->footer("Example: afterglow man run | man -l -");
  return {app, [name, &program](Console&) { return print_page(program, *name); }};
}

}  // namespace afterglow
