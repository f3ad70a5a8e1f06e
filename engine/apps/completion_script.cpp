// SPDX-License-Identifier: MIT
#include "apps/completion_script.h"

#include <fmt/format.h>

#include "core/text.h"

namespace afterglow {
namespace {

constexpr const char* kMade = "# Made by `afterglow completion`: commands and options as the program declares them.\n";

std::string names_of(const std::vector<CommandWords>& commands) {
  std::vector<std::string> names;
  for (const auto& command : commands) names.push_back(command.name);
  return join(names, " ");
}

std::string options_of(const CommandWords& command) {
  std::vector<std::string> names;
  for (const auto& option : command.options)
    if (!option.positional) names.insert(names.end(), option.names.begin(), option.names.end());
  return join(names, " ");
}

bool is_folder(const OptionWords& option) { return option.value.starts_with("FOLDER"); }

/// `text` with `before` in front of each of `special`, and its lines made one.
std::string escaped(const std::string& text, std::string_view special, std::string_view before) {
  std::string out;
  for (const char c : text) {
    if (special.find(c) != std::string_view::npos) out += before;
    out += c == '\n' ? ' ' : c;
  }
  return out;
}

/// In a shell's single quotation marks.
std::string quoted_word(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

std::string bash_completion(const std::vector<CommandWords>& commands) {
  std::string values, options;
  for (const auto& command : commands) {
    options += fmt::format("    {}) words='{}' ;;\n", command.name, options_of(command));
    for (const auto& option : command.options) {
      if (option.positional || (option.choices.empty() && !is_folder(option))) continue;
      std::vector<std::string> keys;
      for (const auto& name : option.names) keys.push_back(command.name + "/" + name);
      values += fmt::format("    {}) COMPREPLY=($(compgen {} -- \"$word\")); return ;;\n", join(keys, " | "),
                            option.choices.empty() ? "-d" : "-W '" + join(option.choices, " ") + "'");
    }
  }
  return kMade + fmt::format(R"(_afterglow() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command=${{COMP_WORDS[1]}} words=
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W '{} --help --version' -- "$word"))
    return
  fi
  case $command/$before in
{}  esac
  [[ $word == -* ]] || return 0
  case $command in
{}  esac
  COMPREPLY=($(compgen -W "$words" -- "$word"))
}}
complete -o default -F _afterglow afterglow
)",
                             names_of(commands), values, options);
}

std::string zsh_completion(const std::vector<CommandWords>& commands) {
  const auto spec = [](const OptionWords& option) {
    const std::string action = !option.choices.empty() ? "(" + join(option.choices, " ") + ")"
                               : is_folder(option)     ? "_directories"
                                                       : "_files";
    const std::string value = escaped(option.value, ":", "\\");
    if (option.positional)
      return quoted_word(fmt::format("{}:{}:{}", option.required ? "" : ":", option.names.front(), action));
    const std::string help = escaped(option.help, "[]:\\", "\\");
    std::string out;
    for (const auto& name : option.names)
      out += (out.empty() ? "" : " ") +
             quoted_word(fmt::format("*{}[{}]{}", name, help, option.value.empty() ? "" : ":" + value + ":" + action));
    return out;
  };
  std::string names, cases;
  for (const auto& command : commands) {
    names += "    " + quoted_word(escaped(command.name, ":", "\\") + ":" + escaped(command.help, "\\", "\\")) + "\n";
    cases += fmt::format("    {})\n      _arguments -s", command.name);
    for (const auto& option : command.options)
      if (!option.positional) cases += " \\\n        " + spec(option);
    cases += " \\\n        '*:file:_files' ;;\n";
  }
  return fmt::format("#compdef afterglow\n{}", kMade) + fmt::format(R"(_afterglow() {{
  local -a commands=(
{}  )
  if ((CURRENT == 2)); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  ((CURRENT--))
  case $command in
{}  esac
}}
_afterglow "$@"
)",
                                                                    names, cases);
}

std::string fish_completion(const std::vector<CommandWords>& commands) {
  std::string out = kMade;
  const auto text = [](const std::string& words) { return "'" + escaped(words, "'\\", "\\") + "'"; };
  for (const auto& command : commands)
    out += fmt::format("complete -c afterglow -n __fish_use_subcommand -f -a {} -d {}\n", command.name,
                       text(command.help));
  for (const auto& command : commands)
    for (const auto& option : command.options) {
      if (option.positional) continue;
      out += fmt::format("complete -c afterglow -n '__fish_seen_subcommand_from {}'", command.name);
      for (const auto& name : option.names)
        out += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (!option.choices.empty())
        out += " -x -a " + text(join(option.choices, " "));
      else if (is_folder(option))
        out += " -x -a '(__fish_complete_directories)'";
      else if (!option.value.empty())
        out += " -r";
      out += " -d " + text(option.help) + "\n";
    }
  return out;
}

}  // namespace afterglow
