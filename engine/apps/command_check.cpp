// SPDX-License-Identifier: MIT
// `afterglow check`: is the preset right, and what would run in which order with which settings? No device needed.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "apps/command.h"
#include "apps/look.h"
#include "apps/output.h"
#include "apps/setting_text.h"
#include "apps/space_text.h"
#include "core/file.h"
#include "core/json_text.h"
#include "core/key_finder.h"
#include "core/printable.h"
#include "core/table.h"
#include "script/explanation.h"

namespace afterglow {
namespace {

using Json = nlohmann::ordered_json;

struct CheckArguments {
  PresetArguments preset;
  AssumedPicture picture;
  bool json = false;
};

const std::string* skip_reason(const Look& look, const StackEntry& entry) {
  for (const auto& skipped : look.build.graph.skipped)
    if (skipped.name == entry.name) return &skipped.reason;
  return nullptr;
}

// Where a value comes from, unless the preset just says it.
std::string origin_text(const SettingHistory& setting) {
  if (setting.overridden) return "(--set)";
  if (!setting.volumes.empty()) return "(volumes)";
  if (!setting.preset) return "(default)";
  return setting.kind == "fixed" ? "" : "(" + setting.kind + ")";
}

std::string entry_text(const Look& look, std::size_t place) {
  const StackEntry& entry = (*look.build.entries)[place - 1];
  const EntrySpace& space = look.spaces[place - 1];
  std::string out = fmt::format("{}{}. {}  at {}, order {}; {}{}{}{}\n", std::string(2 * entry.depth, ' '), place,
                                entry.name, entry.at, entry.order, space_text(space), composition_text(entry),
                                entry.required ? "; required" : "", entry.enabled ? "" : "; not enabled");
  if (!space.warning.empty()) out += fmt::format("   warning: {}\n", space.warning);
  if (!entry.overtakes.empty())
    out += fmt::format("   note: runs before '{}', which is written above it: `at` and `order` say when\n",
                       entry.overtakes);
  if (const auto* reason = skip_reason(look, entry)) out += fmt::format("   skipped: {}\n", *reason);
  Table table;
  const EntryHistory& history = look.build.explanation->entries[place - 1];
  for (const auto& setting : history.settings) table.add({setting.name, setting.value.text(), origin_text(setting)});
  for (const auto& setting : history.composition)
    if (is_said(setting)) table.add({setting.name, setting.value.text(), origin_text(setting)});
  return out + table.text("   ");
}

/// Settings that nobody reads, and effects that were not compiled.
std::vector<std::string> all_notes(const Look& look, const std::vector<std::string>& not_compiled) {
  std::vector<std::string> notes;
  for (const auto& entry : not_compiled)
    notes.push_back(
        fmt::format("note: '{}' runs in none of the frames that were tried: its shaders are not compiled; --frame says "
                    "one in which it runs",
                    entry));
  for (const auto& [effect, setting] : look.build.unread)
    notes.push_back(fmt::format("note: setting '{}' of effect '{}' is never read", setting, effect));
  return notes;
}

/// Settings and other keys that a table of the look's scripts gives twice.
std::vector<std::string> repeated_key_warnings(const Look& look) {
  std::vector<std::string> warnings;
  for (const auto& script : look.preset->scripts()) {
    const auto text = read_file(script);
    if (!text) continue;  // a preset in a pack, or gone since
    for (const auto& [key, first, line] : repeated_keys(*text))
      warnings.push_back(fmt::format("{}:{}: '{}' is given twice in one table; this one counts, not that of line {}",
                                     script.string(), line, key, first));
  }
  return warnings;
}

std::vector<std::string> shadow_notes(const Look& look) {
  std::vector<std::string> notes;
  std::set<std::string> seen;
  for (const auto& entry : *look.build.entries) {
    if (!seen.insert(entry.effect).second) continue;
    const auto& schema = look.preset->schema(entry.effect);
    for (const auto& file : schema.shadowed)
      notes.push_back(fmt::format("{} shadows {}", schema.file.string(), file.string()));
  }
  for (const auto& pass : look.build.graph.passes)
    for (const auto& name : shaders_of(pass)) {
      if (!seen.insert("shader " + name).second) continue;
      const auto files = look.shaders->path().find_shader(name + ".glsl");  // none: it is its folder's own
      for (std::size_t i = 1; i < files.size(); ++i)
        if (std::error_code none;
            !std::filesystem::equivalent(files[0], files[i], none))  // a folder may be there twice
          notes.push_back(fmt::format("{} shadows {}", files[0].string(), files[i].string()));
    }
  return notes;
}

std::string as_text(const Look& look, const std::string& file, const std::vector<std::string>& shadows,
                    const std::vector<std::string>& notes_of_look, std::size_t warnings) {
  const auto& entries = *look.build.entries;
  std::string out = fmt::format("{}: {}\n", file, look.preset->name());
  for (std::size_t i = 0; i < entries.size(); ++i) out += entry_text(look, i + 1);
  if (const auto& arguments = look.preset->arguments(); !arguments.empty()) {
    out += "arguments (--arg NAME=VALUE)\n";
    Table table;
    for (const auto& argument : arguments)
      table.add({argument.schema.name, argument.value.text(), argument.given ? "(--arg)" : "(default)",
                 allowed_text(argument.schema), argument.schema.doc});
    out += table.text("   ");
  }
  for (const auto& notes : {shadows, notes_of_look})
    for (const auto& note : notes) out += note + "\n";
  const std::string warned = warnings == 0 ? "" : fmt::format(", {} warning{}", warnings, warnings == 1 ? "" : "s");
  const auto counted = [](std::size_t count, const std::string& one, const char* many) {
    return fmt::format("{} {}{}", count, one, count == 1 ? "" : many);
  };
  return out + fmt::format("{}, {} in {}: no errors{}\n", counted(entries.size(), "effect", "s"),
                           counted(look.build.graph.passes.size(), "pass", "es"),
                           counted(look.plan.kernels.size(), "kernel", "s"), warned);
}

std::string as_json(const Look& look, const std::string& file, const std::vector<std::string>& shadows,
                    const std::vector<std::string>& notes) {
  Json out{{"file", file}, {"name", look.preset->name()}, {"entries", Json::array()}};
  for (std::size_t i = 0; i < look.build.entries->size(); ++i) {
    const auto& entry = (*look.build.entries)[i];
    Json item{{"name", entry.name},   {"effect", entry.effect},   {"at", entry.at},
              {"order", entry.order}, {"enabled", entry.enabled}, {"required", entry.required}};
    for (const auto& [name, value] : entry.settings) item["settings"][name] = Json(value_json(value));
    item["changed"] = entry.changed;
    add_composition(item, entry, look.build.explanation->entries[i]);
    if (entry.members > 0) item["members"] = entry.members;
    item["light"] = space_json(look.spaces[i]);
    if (const auto* reason = skip_reason(look, entry)) item["skipped"] = *reason;
    out["entries"].push_back(std::move(item));
  }
  out["arguments"] = Json::array();
  for (const auto& argument : look.preset->arguments()) {
    Json item = setting_json(argument.schema);
    item["value"] = Json(value_json(argument.value));
    item["given"] = argument.given;
    out["arguments"].push_back(std::move(item));
  }
  out["passes"] = look.build.graph.passes.size();
  out["kernels"] = look.plan.kernels.size();
  out["shadows"] = shadows;
  out["notes"] = notes;
  return json_text(out);
}

Result<void> run_check(const CheckArguments& arguments, Console& console) {
  console.show_prints();
  AFTERGLOW_TRY(const Look look, load_look(arguments.preset, arguments.picture, console));
  auto [shaders, not_compiled] = check_shaders(look);
  auto& [errors, warnings] = shaders;
  for (const auto& warning : warnings) console.diagnostics().warn(warning);
  for (const auto& warning : repeated_key_warnings(look)) console.diagnostics().warn(warning);
  for (const auto& warning : check_odd_sizes(look)) console.diagnostics().warn(warning);
  if (!errors.empty()) {
    for (std::size_t i = 0; i + 1 < errors.size(); ++i) console.error(errors[i]);
    return std::move(errors.back());
  }
  const auto shadows = shadow_notes(look), notes = all_notes(look, not_compiled);
  const auto& file = arguments.preset.file;
  const auto of_light = std::ranges::count_if(look.spaces, [](const EntrySpace& s) { return !s.warning.empty(); });
  const std::size_t warned = console.warnings() + static_cast<std::size_t>(of_light);
  output("{}", arguments.json ? as_json(look, file, shadows, notes)
                              : printable(as_text(look, file, shadows, notes, warned), true));
  return {};
}

}  // namespace

Command add_check_command(CLI::App& program) {
  auto* app = program.add_subcommand("check", "Check a preset and its shaders; print the resolved order and settings");
  auto arguments = std::make_shared<CheckArguments>();
  arguments->preset.add(*app);
  arguments->picture.add(*app);
  app->add_flag("--json", arguments->json, "Print JSON");
  app->footer("Needs no Vulkan device. The picture is assumed to have every auxiliary input that the stack asks for.");
  return {app, [arguments](Console& console) { return run_check(*arguments, console); }};
}

}  // namespace afterglow
