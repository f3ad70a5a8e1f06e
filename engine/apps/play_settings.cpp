// SPDX-License-Identifier: MIT
#include "apps/play_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <system_error>

#include "apps/options.h"
#include "apps/window_place.h"
#include "core/text.h"
#include "core/user_folders.h"
#include "play/footage.h"
#include "play/transport.h"

namespace afterglow {
namespace {

std::string without_blanks(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

/// What the command itself looks at later, when nobody knows that the value came from here.
Result<void> check_value(const std::string& name, const std::string& value) {
  if (name == "proxy") AFTERGLOW_CHECK(parse_proxy(value));
  if (name == "cache") AFTERGLOW_CHECK(parse_memory(value));
  if (name == "geometry") AFTERGLOW_CHECK(parse_geometry(value));
  if (name == "loop") AFTERGLOW_CHECK(parse_loop_mode(value));
  std::error_code none;
  if (name == "view-icc" && !std::filesystem::exists(value, none))
    return Error{ErrorKind::usage, fmt::format("'{}': there is no such file", value)};
  return {};
}

Result<void> apply_line(CLI::App& command, const std::string& line, const std::string& file, int number) {
  const auto wrong = [&](const std::string& what, const std::string& allowed, const std::string& nearest = {}) {
    return Error{ErrorKind::usage, what, file, number, allowed, nearest};
  };
  const auto equals = line.find('=');
  if (equals == std::string::npos) return wrong(fmt::format("'{}' is no setting", line), "name = value");
  const std::string name = without_blanks(line.substr(0, equals)), value = without_blanks(line.substr(equals + 1));
  const auto& names = play_settings();
  if (std::ranges::find(names, name) == names.end())
    return wrong(fmt::format("there is no setting '{}'", name), join(names), nearest_name(name, names));
  CLI::Option* option = command.get_option_no_throw("--" + name);
  if (!option || option->count() > 0) return {};
  if (option->get_expected_max() == 0 && value != "true" && value != "false")
    return wrong(fmt::format("'{}' is no value of {}", value, name), "true, false");
  try {
    if (const auto good = check_value(name, value); !good)
      return wrong(fmt::format("{}: {}", name, good.error().message), good.error().allowed, good.error().nearest);
    option->add_result(value);
    option->run_callback();
  } catch (const CLI::Error& error) {
    return wrong(error.what(), "");
  }
  return {};
}

/// A comment begins with the line or behind a blank: shot.####.exr holds none.
std::size_t comment_begin(const std::string& line) {
  std::size_t at = line.find('#');
  while (at != std::string::npos && at > 0 && line[at - 1] != ' ' && line[at - 1] != '\t') at = line.find('#', at + 1);
  return at;
}

}  // namespace

std::filesystem::path play_settings_file() {
  const auto folder = config_folder();
  return folder.empty() ? folder : folder / "play.conf";
}

const std::vector<std::string>& play_settings() {
  static const std::vector<std::string> kNames{
      "cache", "device",  "export", "full-screen", "geometry",     "loop",     "mute",      "poll",      "paused",
      "proxy", "readers", "stats",  "ui-scale",    "view-display", "view-icc", "view-name", "view-ocio", "volume"};
  return kNames;
}

Result<void> apply_play_settings(CLI::App& command, const std::string& text, const std::string& file) {
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string said = without_blanks(line.substr(0, comment_begin(line)));
    if (!said.empty()) AFTERGLOW_CHECK(apply_line(command, said, file, number));
  }
  return {};
}

}  // namespace afterglow
