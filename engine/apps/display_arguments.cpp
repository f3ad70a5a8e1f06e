// SPDX-License-Identifier: MIT
#include "apps/display_arguments.h"

#include <fmt/format.h>

#include <cstdlib>
#include <map>

#include "core/file.h"
#include "core/paths.h"
#include "core/text.h"

namespace afterglow {
namespace {

Result<std::filesystem::path> find_config(const std::string& name, const SearchPath& path) {
  std::error_code none;
  std::vector<std::filesystem::path> candidates{name};
  for (const auto& folder : path.user) candidates.push_back(folder / name);
  const auto assets = path.installation / "assets";
  if (!path.installation.empty()) candidates.push_back(assets / name);
  for (const auto& file : candidates)
    if (std::filesystem::is_regular_file(file, none)) return file;
  std::vector<std::string> known;
  for (std::filesystem::directory_iterator it(assets / "ocio", none), end; !none && it != end; it.increment(none))
    if (it->path().extension() == ".ocio") known.push_back("ocio/" + it->path().filename().string());
  return Error{ErrorKind::usage,
               fmt::format("there is no configuration '{}'", name),
               "--view-ocio",
               0,
               "a file, or one beside the preset or on the search path, like ocio/aces.ocio",
               nearest_name(name, known)};
}

/// Tables that OpenColorIO is going to read: it says less about what is wrong with them.
Result<void> check_tables(const OcioSurvey& survey, const std::filesystem::path& config) {
  std::error_code none;
  for (const auto& table : survey.files) {
    if (!std::filesystem::is_regular_file(table.path, none))
      return Error{ErrorKind::script,
                   fmt::format("'{}': there is no such file, like {}", table.name, table.path.string()),
                   config.string()};
    AFTERGLOW_TRY(const std::string text, read_file(table.path));
    AFTERGLOW_CHECK(check_table(text, table.path, TableUse::of_config));
  }
  return {};
}

}  // namespace

void DisplayArguments::add(CLI::App& app) {
  const std::string group = "Window";
  app.add_option("--view-ocio", config,
                 "Show pictures through a view of this OpenColorIO configuration (a file, or ocio/aces.ocio); what is "
                 "written stays without it")
      ->type_name("CONFIG")
      ->group(group);
  app.add_option("--view-display", display, "Its display (default: the configuration's); alone: of $OCIO")
      ->type_name("NAME")
      ->group(group);
  app.add_option("--view-name", view, "The display's view (default: its first)")->type_name("NAME")->group(group);
  app.add_option("--view-icc", profile, "Show pictures on the monitor that has this ICC profile")
      ->type_name("FILE")
      ->group(group);
}

Result<OcioRequest> DisplayArguments::request(const std::filesystem::path& preset,
                                              const std::vector<std::string>& paths) const {
  std::string named = config;
  if (named.empty()) {
    const char* of_environment = std::getenv("OCIO");
    if (!of_environment || !*of_environment)
      return Error{ErrorKind::usage,
                   "there is no configuration: --view-ocio is not given, and the variable OCIO of the environment is "
                   "not set",
                   display.empty() ? "--view-name" : "--view-display", 0, "--view-ocio CONFIG"};
    named = of_environment;
  }
  OcioRequest out;
  out.display = display;
  out.view = view;
  AFTERGLOW_TRY(out.config, find_config(named, search_path_for(preset, {paths.begin(), paths.end()})));
  AFTERGLOW_TRY(const OcioSurvey survey, survey_ocio(out));
  if (const auto& fault = survey.fault) {
    const std::map<std::string, std::string> options{{"display", "--view-display"}, {"view", "--view-name"}};
    const auto option = options.find(fault->key);
    return Error{ErrorKind::usage,
                 fmt::format("{} ({})", fault->what, out.config.filename().string()),
                 option == options.end() ? "--view-ocio" : option->second,
                 0,
                 fault->allowed,
                 fault->nearest};
  }
  AFTERGLOW_CHECK(check_tables(survey, out.config));
  return out;
}

Result<std::optional<ShownDisplay>> DisplayArguments::shown(const std::filesystem::path& preset,
                                                            const std::vector<std::string>& paths) const {
  if (!any()) return std::optional<ShownDisplay>{};
  if (!profile.empty()) {
    if (!(config.empty() && display.empty() && view.empty()))
      return Error{ErrorKind::usage, "a view of OpenColorIO is for its own display: it goes without a profile",
                   "--view-icc"};
    AFTERGLOW_TRY(DisplayTable made, icc_display_table(profile));
    return std::optional(ShownDisplay{.table = std::move(made), .files = {profile}});
  }
  AFTERGLOW_TRY(const OcioRequest asked, request(preset, paths));
  AFTERGLOW_TRY(ShownDisplay made, display_of_config(asked));
  return std::optional(std::move(made));
}

}  // namespace afterglow
