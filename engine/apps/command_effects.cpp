// SPDX-License-Identifier: MIT
// `afterglow effects [NAME]`: what effects there are and what they can be set to, from their own declarations.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/command.h"
#include "apps/effect_page.h"
#include "apps/options.h"
#include "apps/output.h"
#include "apps/setting_text.h"
#include "core/json_text.h"
#include "core/printable.h"
#include "core/table.h"
#include "core/text.h"
#include "script/preset.h"
#include "script/schema.h"

namespace afterglow {
namespace {

const std::string kMask = "mask.";  // before the names of masks

struct EffectsArguments {
  std::string name;
  PresetArguments preset;  // --path alone
  bool json = false, markdown = false, completion = false, masks = false;
};

nlohmann::json space_json(const EffectSchema& effect, LightSpace space) {
  return effect.space_by_settings ? "by settings" : space_name(space);
}

nlohmann::json as_json(const EffectSchema& effect) {
  auto settings = nlohmann::json::array();
  for (const auto& setting : effect.settings) settings.push_back(setting_json(setting));
  nlohmann::json out{{"name", effect.name},
                     {"doc", effect.doc},
                     {"at", effect.at},
                     {"order", effect.order},
                     {"needs_light", space_json(effect, effect.space.needs)},
                     {"makes_light", space_json(effect, effect.space.makes)},
                     {"file", effect.file.string()},
                     {"settings", std::move(settings)}};
  for (const auto& [key, list] : {std::pair("needs", &effect.needs), std::pair("optional", &effect.optional)})
    out[key] = list->by_settings ? nlohmann::json("by settings") : nlohmann::json(list->names);
  for (const auto& hold : effect.invariants) out["holds"].push_back(invariant_text(hold));
  for (const auto& file : effect.shadowed) out["shadowed"].push_back(file.string());
  return out;
}

nlohmann::json mask_json(const EffectSchema& mask) {
  nlohmann::json out = as_json(mask);
  for (const char* key : {"at", "order", "needs_light", "makes_light"}) out.erase(key);
  out["kind"] = "mask";
  return out;
}

std::string list_text(const std::vector<EffectSchema>& effects, const std::vector<EffectSchema>& masks) {
  Table table({"effect", "at", "order", "what it does"});
  for (const auto& effect : effects) table.add({effect.name, effect.at, std::to_string(effect.order), effect.doc});
  Table others({"mask", "what it selects"});
  for (const auto& mask : masks) others.add({kMask + mask.name, mask.doc});
  return table.text() + "\n" + others.text() +
         "\nEvery effect takes opacity, blend and mask (`mask = fx.mask.NAME { … }`) besides its settings.\n"
         "`afterglow effects NAME` lists the settings of an effect, or of a mask (mask.luma).\n";
}

std::string settings_text(const EffectSchema& effect) {
  Table table({"setting", "type", "allowed", "default", "what it does"});
  for (const auto& setting : effect.settings)
    table.add(
        {setting.name, type_text(setting.type), allowed_text(setting), setting.default_value.text(), setting.doc});
  return table.text("  ");
}

std::string mask_text(const EffectSchema& mask) {
  std::string inputs = inputs_text(mask);
  if (!inputs.empty()) inputs += "\n";
  return fmt::format("{}{}: {}\n{}\n{}\n{}", kMask, mask.name, mask.doc, mask.file.string(), inputs,
                     settings_text(mask));
}

std::string effect_text(const EffectSchema& effect) {
  std::string about = space_text(effect);
  if (const auto inputs = inputs_text(effect); !inputs.empty()) about += " " + inputs;
  std::string out = fmt::format("{}: {}\nat {}, order {}; {}\n{}\n\n{}", effect.name, effect.doc, effect.at,
                                effect.order, effect.file.string(), about, settings_text(effect));
  if (!effect.invariants.empty()) {
    std::vector<std::string> promises;
    for (const auto& hold : effect.invariants) promises.push_back(invariant_text(hold));
    out += fmt::format("\nholds: {}\n", join(promises));
  }
  for (const auto& file : effect.shadowed) out += fmt::format("\nshadows {}\n", file.string());
  return out;
}

Result<void> run_effects(const EffectsArguments& arguments, Console& console) {
  AFTERGLOW_CHECK(arguments.preset.check_paths());
  if (arguments.masks && !arguments.json)
    return Error{ErrorKind::usage, "--masks belongs to --json", "afterglow effects"};
  const std::vector<std::filesystem::path> extra(arguments.preset.paths.begin(), arguments.preset.paths.end());
  AFTERGLOW_TRY(auto effects, list_effects(search_path_for({}, extra), console.diagnostics()));
  if (effects.empty())
    return Error{ErrorKind::script, "no effects were found", "afterglow effects", 0,
                 "an installation with scripts/effects (AFTERGLOW_HOME names its folder), --path, AFTERGLOW_PATH"};
  AFTERGLOW_TRY(auto masks, list_masks(search_path_for({}, extra), console.diagnostics()));
  if (!arguments.name.empty()) {
    std::vector<std::string> names;
    for (const auto& effect : effects) names.push_back(effect.name);
    for (const auto& mask : masks) names.push_back(kMask + mask.name);
    std::erase_if(effects, [&](const auto& effect) { return effect.name != arguments.name; });
    std::erase_if(masks, [&](const auto& mask) { return kMask + mask.name != arguments.name; });
    if (effects.empty() && masks.empty()) {
      if (auto error = effect_error(search_path_for({}, extra), arguments.name)) return *std::move(error);
      return Error{ErrorKind::usage,
                   fmt::format("unknown effect '{}'", arguments.name),
                   "afterglow effects",
                   0,
                   join(names) + "; effects of yours with --path FOLDER (--path . for this one's)",
                   nearest_name(arguments.name, names)};
    }
  }
  if (arguments.completion) {
    output("{}", completion_text(effects, masks));
  } else if (arguments.markdown) {
    for (const auto& effect : effects) output("{}", effect_page(effect));
  } else if (arguments.json) {
    auto list = nlohmann::json::array();
    if (!arguments.masks)
      for (const auto& effect : effects) list.push_back(as_json(effect));
    if (arguments.masks || effects.empty())
      for (const auto& mask : masks) list.push_back(mask_json(mask));
    output("{}", json_text(list));
  } else {
    output("{}", printable(arguments.name.empty() ? list_text(effects, masks)
                           : effects.empty()      ? mask_text(masks.front())
                                                  : effect_text(effects.front()),
                           true));
  }
  return {};
}

}  // namespace

Command add_effects_command(CLI::App& program) {
  auto* app = program.add_subcommand("effects", "List the effects, or the settings of one");
  auto arguments = std::make_shared<EffectsArguments>();
  app->add_option("EFFECT", arguments->name, "Effect whose settings to show, or mask (mask.luma)");
  app->add_flag("--masks", arguments->masks, "With --json: the masks instead of the effects");
  app->add_flag("--json", arguments->json, "Print JSON");
  app->add_flag("--markdown", arguments->markdown, "Print documents in Markdown");
  app->add_flag("--completion", arguments->completion, "Print completion data for lua-language-server (scripts/_meta)");
  arguments->preset.add_paths(*app);
  return {app, [arguments](Console& console) { return run_effects(*arguments, console); }};
}

}  // namespace afterglow
