// SPDX-License-Identifier: MIT
#include "apps/command_words.h"

#include <algorithm>

#include "core/text.h"

namespace afterglow {
namespace {

/// CLI11 tells "FORMAT:{dot,svg,json}" of an option with these values, "FILE" of others.
void read_type(const std::string& type, OptionWords& out) {
  const std::size_t colon = type.find(':'), open = type.find('{'), close = type.find('}');
  out.value = type.substr(0, std::min(colon, open));
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
  return out;
}

}  // namespace

std::vector<CommandWords> command_words(const CLI::App& program) {
  std::vector<CommandWords> out;
  for (const CLI::App* app : program.get_subcommands([](const CLI::App*) { return true; })) {
    CommandWords command{app->get_name(), app->get_description(), app->get_footer(), {}};
    for (const CLI::Option* option : app->get_options()) command.options.push_back(words_of_option(*option));
    std::ranges::stable_sort(command.options, std::ranges::greater{}, &OptionWords::positional);
    out.push_back(std::move(command));
  }
  return out;
}

}  // namespace afterglow
