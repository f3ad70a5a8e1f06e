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

/// What a shell offers for a value; empty: files.
const std::vector<std::string>& offered(const OptionWords& option) {
  return option.choices.empty() ? option.usual : option.choices;
}

/// The first word behind a command's name, where words are offered for it.
const OptionWords* first_word(const CommandWords& command) {
  if (command.options.empty()) return nullptr;
  const OptionWords& first = command.options.front();  // positionals are
  return first.positional && !offered(first).empty() ? &first : nullptr;
}

/// Files may stand there too: a word that is all that is taken, and a command's name, are no files.
bool takes_files(const OptionWords& option) { return option.choices.empty() && option.names.front() == "PRESET"; }

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
  std::string values, firsts, options;
  for (const auto& command : commands) {
    if (const OptionWords* first = first_word(command))
      firsts += fmt::format("      {}) words='{}'{} ;;\n", command.name, join(offered(*first), " "),
                            takes_files(*first) ? "" : " files=");
    options += fmt::format("    {}) words='{}' ;;\n", command.name, options_of(command));
    for (const auto& option : command.options) {
      if (option.positional || (offered(option).empty() && !is_folder(option) && !option.settings)) continue;
      std::vector<std::string> keys;
      for (const auto& name : option.names) keys.push_back(command.name + "/" + name);
      const std::string reply = option.settings           ? "_afterglow_settings \"$word\""
                                : offered(option).empty() ? "_afterglow_folders \"$word\""
                                                          : fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$word\"))",
                                                                        join(offered(option), " "));
      values += fmt::format("    {}) {}; return ;;\n", join(keys, " | "), reply);
    }
  }
  return kMade + fmt::format(R"(_afterglow_folders() {{
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -d -- "$1")
}}
_afterglow_settings() {{
  compopt -o nospace +o default 2>/dev/null
  local known=$("${{COMP_WORDS[0]}}" completion bash --settings -- "${{COMP_WORDS[@]:2:COMP_CWORD-2}}" 2>/dev/null)
  COMPREPLY=($(compgen -W "$known" -- "$1"))
}}
_afterglow() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command=${{COMP_WORDS[1]}} words= files=1
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W '{} --help --version' -- "$word"))
    return
  fi
  case $command/$before in
{}  esac
  if [[ $word != -* ]]; then
    ((COMP_CWORD == 2)) || return 0
    case $command in
{}      *) return 0 ;;
    esac
    if [[ -n $files ]]; then
      compopt -o filenames 2>/dev/null
      mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word"; compgen -f -- "$word")
      return
    fi
    compopt +o default 2>/dev/null  # no files where no word fits
  fi
  if [[ $word == -* ]]; then
    case $command in
{}    esac
  fi
  COMPREPLY=($(compgen -W "$words" -- "$word"))
}}
complete -o default -F _afterglow afterglow
)",
                             names_of(commands), values, firsts, options);
}

std::string zsh_completion(const std::vector<CommandWords>& commands) {
  const auto spec = [](const OptionWords& option) {
    const std::string action = option.settings            ? "_afterglow_settings"
                               : !offered(option).empty() ? "(" + join(offered(option), " ") + ")"
                               : is_folder(option)        ? "_directories"
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
    if (const OptionWords* first = first_word(command))
      cases += fmt::format(" \\\n        '1:{}:{{compadd -- {}{}}}'", first->names.front(), join(offered(*first), " "),
                           takes_files(*first) ? "; _files" : "");
    cases += " \\\n        '*:file:_files' ;;\n";
  }
  return fmt::format("#compdef afterglow\n{}", kMade) + fmt::format(R"(_afterglow_settings() {{
  compadd -S '' -- $($program completion zsh --settings -- $words[2,CURRENT-1] 2>/dev/null)
}}
_afterglow() {{
  local -a commands=(
{}  )
  if ((CURRENT == 2)); then
    _describe command commands
    return
  fi
  local program=$words[1] command=$words[2]
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
  std::string out = kMade + std::string(R"(function __afterglow_settings
  set -l words (commandline -opc)
  $words[1] completion fish --settings -- $words[3..-1] 2>/dev/null
end
)");
  const auto text = [](const std::string& words) { return "'" + escaped(words, "'\\", "\\") + "'"; };
  for (const auto& command : commands)
    out += fmt::format("complete -c afterglow -n __fish_use_subcommand -f -a {} -d {}\n", command.name,
                       text(command.help));
  for (const auto& command : commands)
    if (const OptionWords* first = first_word(command))
      out += fmt::format(
          "complete -c afterglow -n '__fish_seen_subcommand_from {}; and test (count (commandline -opc)) -eq 2'{} -a "
          "{}\n",
          command.name, takes_files(*first) ? "" : " -f", text(join(offered(*first), " ")));
  for (const auto& command : commands)
    for (const auto& option : command.options) {
      if (option.positional) continue;
      out += fmt::format("complete -c afterglow -n '__fish_seen_subcommand_from {}'", command.name);
      for (const auto& name : option.names)
        out += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (option.settings)
        out += " -x -a '(__afterglow_settings)'";
      else if (!offered(option).empty())
        out += " -x -a " + text(join(offered(option), " "));
      else if (is_folder(option))
        out += " -x -a '(__fish_complete_directories)'";
      else if (!option.value.empty())
        out += " -r";
      out += " -d " + text(option.help) + "\n";
    }
  return out;
}

}  // namespace afterglow
