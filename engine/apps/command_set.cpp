// SPDX-License-Identifier: MIT
// `afterglow set`: changes settings in the text of a preset. No device needed.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "apps/command.h"
#include "apps/options.h"
#include "apps/output.h"
#include "apps/text_difference.h"
#include "core/pack.h"
#include "core/paths.h"
#include "core/printable.h"
#include "edit/write_back.h"
#include "shader/library.h"

namespace afterglow {
namespace {

struct SetArguments {
  PresetArguments preset;
  std::vector<std::string> settings, resets;
  bool dry_run = false;
};

Result<std::vector<Override>> overrides_of(const std::vector<std::string>& settings) {
  std::vector<Override> wanted;
  for (const auto& text : settings) {
    auto given = parse_override(text);
    if (!given)
      return Error{ErrorKind::usage, fmt::format("'{}' is no setting with a value", text), "afterglow set", 0,
                   "ENTRY.SETTING=VALUE"};
    wanted.push_back(std::move(*given));
  }
  return wanted;
}

Result<std::vector<PresetEdit>> edits_of(const SetArguments& arguments, const std::filesystem::path& file,
                                         const PresetOptions& options, Console& console) {
  if (arguments.settings.empty() && arguments.resets.empty())
    return Error{ErrorKind::usage, "nothing to change", "afterglow set", 0,
                 "ENTRY.SETTING=VALUE, --reset ENTRY.SETTING"};
  AFTERGLOW_TRY(const auto wanted, overrides_of(arguments.settings));
  for (const auto& one : wanted)
    if (const std::string name = one.entry + "." + one.setting; std::ranges::count(arguments.resets, name) > 0)
      return Error{ErrorKind::usage, fmt::format("'{}' is to be set and reset", name), "afterglow set"};
  ShaderLibrary shaders(search_path_for(file, options.paths));
  AFTERGLOW_TRY(const Preset preset, Preset::load(file, options, shaders, console.diagnostics()));
  AFTERGLOW_TRY(auto edits, parse_edits(preset, wanted));
  AFTERGLOW_TRY(const auto resets, parse_resets(preset, arguments.resets));
  edits.insert(edits.end(), resets.begin(), resets.end());
  return edits;
}

/// A file that is not there yet may be made later: that is told, and no error.
void warn_of_missing_files(const std::vector<PresetEdit>& edits, const SearchPath& path, Console& console) {
  for (const auto& edit : edits)
    if (edit.value && edit.value->type == SettingType::file && !edit.value->choice.empty() &&
        path.find_asset(edit.value->choice).empty())
      console.diagnostics().warn(
          fmt::format("{} = \"{}\": there is no such file beside the preset or on the search path", edit.name(),
                      tidy_message(edit.value->choice, 100)));
}

/// Whoever writes a path knows which file it is; a name may mean one that others use too.
Result<void> check_own(const std::string& given, const std::filesystem::path& file) {
  if (file == given || !is_of_installation(file) || !pack_of(file, cache_folder()).empty()) return {};
  const bool own_folder = file.parent_path().filename() == file.stem();  // with effects and shaders of its own
  return Error{ErrorKind::usage, "comes along with Afterglow and stays as it is: copy it first", given, 0,
               fmt::format("a file of yours, as `cp {} .` makes one",
                           own_folder ? "-r " + file.parent_path().string() : file.string())};
}

Result<void> run_set(const SetArguments& arguments, Console& console) {
  AFTERGLOW_TRY(const auto file, arguments.preset.preset_file());
  AFTERGLOW_CHECK(check_own(arguments.preset.file, file));
  arguments.preset.tell_of_namesake(file, console.diagnostics());
  AFTERGLOW_TRY(const PresetOptions options, arguments.preset.options());
  AFTERGLOW_TRY(const auto edits, edits_of(arguments, file, options, console));
  PresetWriter writer(file, options);
  AFTERGLOW_TRY(const Rewrite rewrite, writer.plan(edits));
  if (!rewrite.refused.empty()) {
    for (std::size_t i = 0; i + 1 < rewrite.refused.size(); ++i) console.error(rewrite.refused[i].reason);
    Error last = rewrite.refused.back().reason;
    last.trail.emplace_back("nothing was written");
    return last;
  }
  for (const auto& note : rewrite.notes) console.diagnostics().warn(note);
  warn_of_missing_files(edits, search_path_for(file, options.paths), console);
  AFTERGLOW_CHECK(arguments.dry_run ? writer.check_file() : writer.save(rewrite));
  output("{}", difference_text(file.string(), rewrite.before, rewrite.text));
  if (rewrite.text == rewrite.before) console.diagnostics().note("the preset says so already; nothing was written");
  return {};
}

}  // namespace

Command add_set_command(CLI::App& program) {
  auto* app = program.add_subcommand("set", "Change settings in the text of a preset");
  auto arguments = std::make_shared<SetArguments>();
  app->add_option("PRESET", arguments->preset.file, "Preset to change: a file, or a name on the search path")
      ->required();
  app->add_option("SETTING", arguments->settings, "What is to be: bloom.intensity=0.4, bloom.enabled=false")
      ->type_name("ENTRY.SETTING=VALUE");
  add_repeatable(*app, "--reset", arguments->resets, "Back to the default (repeatable)", "ENTRY.SETTING");
  app->add_flag("-n,--dry-run", arguments->dry_run, "Show what would change; write nothing");
  arguments->preset.add_paths(*app);
  app->footer(
      "Comments, layout and all else stay byte for byte. What a script computes is never overwritten: it is an error "
      "that names\n"
      "its place, and nothing is written then. Other files (presets that this one extends, required scripts) stay as "
      "they are.\n"
      "Presets that come along with Afterglow are not written: copy one first.\n"
      "Prints the lines that changed. Needs no Vulkan device.\n"
      "Example: afterglow set look.lua bloom.intensity=0.4 bloom.mode=additive --reset bloom.scatter");
  return {app, [arguments](Console& console) { return run_set(*arguments, console); }};
}

}  // namespace afterglow
