// SPDX-License-Identifier: MIT
// `afterglow explain`: where each setting of a frame comes from, and what becomes of each effect and pass. No device
// needed.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "apps/command.h"
#include "apps/explain_view.h"
#include "apps/output.h"
#include "core/printable.h"
#include "core/text.h"

namespace afterglow {
namespace {

struct ExplainArguments {
  PresetArguments preset;
  AssumedPicture picture;
  std::string setting, format = "text";
};

/// "ENTRY.SETTING" or "ENTRY" of the stack into the view.
Result<void> choose(const std::string& text, ExplainView& view) {
  const auto wrong = [](std::string message, const std::string& name, const std::vector<std::string>& names) {
    return Error{ErrorKind::usage, std::move(message), "afterglow explain", 0, join(names), nearest_name(name, names)};
  };
  const std::size_t dot = text.find('.');
  view.entry = text.substr(0, dot);
  std::vector<std::string> names;
  const StackEntry* entry = nullptr;
  for (const auto& candidate : *view.look.build.entries) {
    names.push_back(candidate.name);
    if (candidate.name == view.entry) entry = &candidate;
  }
  if (!entry) return wrong(fmt::format("the stack has no entry '{}'", view.entry), view.entry, names);
  if (dot == std::string::npos) return {};
  view.setting = text.substr(dot + 1);
  names = view.look.preset->setting_names(*entry);
  if (const std::string mask = script::missing_mask(view.setting, names); !mask.empty())
    return wrong(fmt::format("'{}' has no mask '{}'", view.entry, mask), view.setting, names);
  if (std::ranges::find(names, view.setting) == names.end())
    return wrong(fmt::format("'{}' has no setting '{}'", view.entry, view.setting), view.setting, names);
  return {};
}

Result<void> run_explain(const ExplainArguments& arguments, Console& console) {
  AFTERGLOW_TRY(const Look look, load_look(arguments.preset, arguments.picture, console));
  ExplainView view{look, arguments.preset.file, look.build.context, moving_passes(look), "", ""};
  if (!arguments.setting.empty()) AFTERGLOW_CHECK(choose(arguments.setting, view));
  output("{}", arguments.format == "json" ? explain_json(view) : printable(explain_text(view), true));
  return {};
}

}  // namespace

Command add_explain_command(CLI::App& program) {
  auto* app = program.add_subcommand("explain", "Tell where each setting comes from, and what runs and what does not");
  auto arguments = std::make_shared<ExplainArguments>();
  arguments->preset.add(*app);
  app->add_option("SETTING", arguments->setting, "Show this alone: an entry, or one of its settings (bloom.intensity)");
  arguments->picture.add(*app);
  app->add_option("--format", arguments->format, "text or json (default text)")
      ->check(CLI::IsMember({"text", "json"}))
      ->type_name("FORMAT");
  app->footer(
      "Needs no Vulkan device.\n"
      "Example: afterglow explain cave.lua bloom.intensity --frame 12 --at 4,0,0");
  return {app, [arguments](Console& console) { return run_explain(*arguments, console); }};
}

}  // namespace afterglow
