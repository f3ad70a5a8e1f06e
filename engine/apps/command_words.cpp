// SPDX-License-Identifier: MIT
#include "apps/command_words.h"

#include <algorithm>
#include <iterator>

#include "apps/farm_arguments.h"
#include "apps/usual_words.h"
#include "core/text.h"

namespace afterglow {
namespace {

/// CLI11 tells "FORMAT:{dot,svg,json}" of an option with these values, "FILE" of others.
void read_type(const std::string& type, OptionWords& out) {
  const std::size_t open = type.find('{'), close = type.find('}');
  out.value = type.substr(0, type.find_first_of(":{["));  // "FILE[:CHANNEL]"
  if (open != std::string::npos && close != std::string::npos && open < close)
    out.choices = split(type.substr(open + 1, close - open - 1), ',');
}

OptionWords words_of_option(const CLI::Option& option) {
  OptionWords out;
  out.help = option.get_description();
  out.group = option.get_group();
  out.required = option.get_required();
  for (const auto& name : option.get_snames()) out.names.push_back("-" + name);
  for (const auto& name : option.get_lnames()) out.names.push_back("--" + name);
  out.positional = out.names.empty();
  if (out.positional) out.names.push_back(option.get_name(true));
  if (option.get_items_expected_max() == 0) return out;
  read_type(option.get_type_name(), out);
  if (out.value.empty()) out.value = "VALUE";
  out.settings = !out.positional && out.value.ends_with(".SETTING=VALUE");
  if (out.choices.empty()) out.usual = usual_words(out.positional ? out.names.front() : out.value);
  return out;
}

/// What an option of a command takes from the commands themselves.
void add_words_of_commands(const std::string& command, const std::vector<CommandWords>& all, OptionWords& option) {
  if (option.names.front() == "COMMAND")
    for (const CommandWords& other : all) option.usual.push_back(other.name);
  if (command == "farm" && option.names.front() == "PRESET")
    std::ranges::copy(farm_words(), std::back_inserter(option.usual));
}

}  // namespace

std::vector<CommandWords> command_words(const CLI::App& program) {
  std::vector<CommandWords> out;
  for (const CLI::App* app : program.get_subcommands([](const CLI::App*) { return true; })) {
    CommandWords command{app->get_name(), app->get_description(), app->get_footer(), {}};
    for (const CLI::Option* option : app->get_options())
      if (!option->get_group().empty()) command.options.push_back(words_of_option(*option));  // else it is hidden
    std::ranges::stable_sort(command.options, std::ranges::greater{}, &OptionWords::positional);
    out.push_back(std::move(command));
  }
  for (CommandWords& command : out)
    for (OptionWords& option : command.options) add_words_of_commands(command.name, out, option);
  return out;
}

}  // namespace afterglow
