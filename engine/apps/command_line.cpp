// SPDX-License-Identifier: MIT
#include "apps/command_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "apps/command.h"
#include "apps/commit.h"
#include "apps/driver_cache.h"
#include "apps/interrupt.h"
#include "apps/options.h"
#include "apps/output.h"
#include "core/exception.h"
#include "core/text.h"
#include "core/version.h"

namespace afterglow {
namespace {

constexpr const char* kFooter =
    "Exit codes: 0 done, 2 usage, 3 preset or script, 4 input or output, 5 device, 130 interrupted, 1 anything else.\n"
    "Environment: AFTERGLOW_HOME installation to use, AFTERGLOW_PATH further folders with effects/ and shaders/ (':' "
    "between),\n"
    "             AFTERGLOW_CACHE folder for caches, AFTERGLOW_VALIDATE=1 Vulkan validation, NO_COLOR no colours,\n"
    "             AFTERGLOW_EDITOR what F4 of `play` calls, like 'code -g {file}:{line}', OCIO the configuration of\n"
    "             colour spaces, AFTERGLOW_INPUT_TIMEOUT seconds to wait for slow input.\n"
    "`afterglow COMMAND --help` tells the rest.";

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const auto* option : command.get_options()) {
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
    for (const auto& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

bool is_file_like_option(const std::string& word) {
  std::error_code none;
  return word.size() > 1 && word[0] == '-' && std::filesystem::exists(word, none);
}

/// Its dashes make an option no more like another.
std::string nearest_option(const std::string& name, const std::vector<std::string>& options) {
  const auto bare = [](const std::string& option) { return option.substr(option.find_first_not_of('-')); };
  std::vector<std::string> names;
  if (name.find_first_not_of('-') == std::string::npos) return {};
  std::ranges::transform(options, std::back_inserter(names), bare);
  const std::string nearest = nearest_name(bare(name), names);
  const auto at = std::ranges::find(names, nearest) - names.begin();
  return nearest.empty() ? nearest : options[static_cast<std::size_t>(at)];
}

/// An option or word that the command does not know, with the nearest that it does.
Error unknown_argument(const CLI::App& command, const std::string& argument) {
  const std::string where = "afterglow " + command.get_name();
  if (argument.empty() || argument[0] != '-')
    return {ErrorKind::usage, fmt::format("unexpected argument '{}'", argument), where};
  if (is_file_like_option(argument))
    return {ErrorKind::usage, fmt::format("'{}' is read as an option; name the file ./{}", argument, argument), where};
  const std::string name = argument.substr(0, argument.find('='));
  Error error{ErrorKind::usage, fmt::format("unknown option '{}'", name), where};
  error.nearest = nearest_option(name, option_names(command));
  if (error.nearest.empty()) error.allowed = fmt::format("see `{} --help`", where);
  return error;
}

Error unknown_command(const std::string& word, const std::vector<Command>& commands) {
  if (word == "help") return {ErrorKind::usage, "unknown command 'help'", "afterglow", 0, "see `afterglow --help`"};
  std::vector<std::string> names;
  for (const auto& command : commands) names.push_back(command.options->get_name());
  return {ErrorKind::usage,         fmt::format("unknown command '{}'", word), "afterglow", 0, join(names),
          nearest_name(word, names)};
}

/// The command that was parsed, or null.
const Command* parsed_command(const std::vector<Command>& commands) {
  for (const auto& command : commands)
    if (command.options->parsed()) return &command;
  return nullptr;
}

/// The command that the first word names, or null.
const Command* named_command(const std::vector<Command>& commands, int argc, char** argv) {
  for (const auto& command : commands)
    if (argc > 1 && command.options->get_name() == argv[1]) return &command;
  return nullptr;
}

/// What is wrong with words that were given names no file: it begins with the command that was given them.
Error named(Error error, const Command& command) {
  if (error.kind == ErrorKind::usage && error.file.empty()) error.file = "afterglow " + command.options->get_name();
  return error;
}

int fail(Console& console, const Error& error) {
  console.end_progress();
  console.error(error);
  return static_cast<int>(error.kind);
}

/// Parses into the commands' options. Returns an exit code when there is nothing more to do.
std::optional<int> parse(CLI::App& program, const std::vector<Command>& commands, int argc, char** argv,
                         Console& console) {
  if (argc > 1 && argv[1][0] != '-' && !named_command(commands, argc, argv))
    return fail(console, unknown_command(argv[1], commands));
  if (const Command* command = named_command(commands, argc, argv); command && command->behind)
    for (int i = 2; i < argc; ++i)
      if (std::string_view(argv[i]) == "--") {
        command->behind->assign(argv + i + 1, argv + argc);
        argc = i;
      }
  try {
    program.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::Success& wanted) {  // --help, --version
    std::ostringstream text;
    const int exit_code = program.exit(wanted, text, text);
    output("{}", text.str());
    return exit_code;
  } catch (const CLI::ExtrasError&) {
    const Command* command = parsed_command(commands);
    const CLI::App& app = command ? *command->options : program;
    const auto extras = program.remaining(true);
    return fail(console, unknown_argument(app, extras.empty() ? "" : extras.front()));
  } catch (const CLI::ParseError& error) {
    const Command* command = parsed_command(commands);
    if (command == nullptr && argc <= 1) {
      fmt::print(stderr, "{}", program.help());
      return static_cast<int>(ErrorKind::usage);
    }
    // A misspelt option swallows the words behind it, so that others seem to be missing: name the misspelt one.
    if (command != nullptr) {
      const auto known = option_names(*command->options);
      for (int i = 2; i < argc; ++i) {
        const std::string word = argv[i];
        const std::string name = word.substr(0, word.find('='));
        if (word == "--") break;
        if (is_file_like_option(word) && std::find(known.begin(), known.end(), name) == known.end())
          return fail(console, unknown_argument(*command->options, word));
        if (word.starts_with("--") && std::find(known.begin(), known.end(), name) == known.end())
          return fail(console, unknown_argument(*command->options, word));
      }
    }
    const std::string where = command ? "afterglow " + command->options->get_name() : "afterglow";
    return fail(console, {ErrorKind::usage, exception_text(error), where});
  }
}

struct KnownCommand {
  std::string_view name;
  Command (*add)(CLI::App& program);
};

constexpr KnownCommand kCommands[] = {
    {"run", add_run_command},         {"check", add_check_command},         {"graph", add_graph_command},
    {"explain", add_explain_command}, {"effects", add_effects_command},     {"new", add_new_command},
    {"set", add_set_command},         {"devices", add_devices_command},     {"play", add_play_command},
#ifdef AFTERGLOW_BENCH
    {"bench", add_bench_command},     {"calibrate", add_calibrate_command}, {"stress", add_stress_command},
#endif
    {"bake", add_bake_command},       {"farm", add_farm_command},
};

/// The command that the first word names; all of them where it names none, or one that tells of all.
std::vector<Command> add_commands(CLI::App& program, std::string_view first) {
  std::vector<Command> commands;
  const auto named = std::ranges::find(kCommands, first, &KnownCommand::name);
  if (named != std::end(kCommands)) {
    commands.push_back(named->add(program));
    return commands;
  }
  for (const KnownCommand& command : kCommands) commands.push_back(command.add(program));
  commands.push_back(add_completion_command(program));
  commands.push_back(add_man_command(program));
  return commands;
}

enum class Work { all, parsing };

int run(Console& console, int argc, char** argv, Work work) {
  CLI::App program("Finishes rendered pictures: Lua looks on Vulkan.", "afterglow");
  const std::string of_commit = *commit() ? fmt::format(" (commit {})", commit()) : "";
  program.set_version_flag("--version", fmt::format("afterglow {}{}", version(), of_commit));
  program.require_subcommand(1);
  program.footer(kFooter);
  program.get_formatter()->column_width(34);

  const std::vector<Command> commands = add_commands(program, argc > 1 ? argv[1] : "");
  MessageArguments messages;
  for (const auto& command : commands) messages.add(*command.options);

  if (const auto exit_code = parse(program, commands, argc, argv, console)) return *exit_code;
  if (work == Work::parsing) return 0;
  messages.apply(console);
  if (const auto told = avoid_full_driver_cache()) console.diagnostics().note(*told);
  const Command& command = *parsed_command(commands);
  const auto done = command.run(console);
  return done ? 0 : fail(console, named(done.error(), command));
}

}  // namespace

int run_command_line(int argc, char** argv) {
  Console console;
  install_interrupt_handler();
  int exit_code = 0;
  try {
    exit_code = run(console, argc, argv, Work::all);
  } catch (const std::exception& exception) {
    exit_code = fail(console, exception_error(exception));
  }
  const auto told = finish_output();
  return exit_code == 0 && !told ? fail(console, told.error()) : exit_code;
}

int check_command_line(int argc, char** argv) {
  Console console;
  return run(console, argc, argv, Work::parsing);
}

}  // namespace afterglow
