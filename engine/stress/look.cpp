#include "stress/look.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "script/build.h"

namespace afterglow::stress {
namespace {

std::string entry_text(const LookEntry& entry) {
  std::vector<std::string> keys;
  if (!entry.at.empty()) keys.push_back(fmt::format("at = \"{}\", order = {}", entry.at, entry.order));
  for (const auto& [name, value] : entry.settings) keys.push_back(fmt::format("{} = {}", name, value.text()));
  return keys.empty() ? fmt::format("fx.{} {{}}", entry.effect)
                      : fmt::format("fx.{} {{ {} }}", entry.effect, join(keys));
}

}  // namespace

const SettingValue* LookEntry::find(const std::string& setting) const {
  const auto found = std::ranges::find(settings, setting, &std::pair<std::string, SettingValue>::first);
  return found == settings.end() ? nullptr : &found->second;
}

void LookEntry::set(const std::string& setting, const SettingValue& value) {
  std::erase_if(settings, [&](const auto& one) { return one.first == setting; });
  settings.emplace_back(setting, value);
}

std::string Look::text() const {
  std::string out = "local fx = require \"afterglow\"\n\nreturn fx.stack {\n";
  for (const auto& entry : entries) out += "  " + entry_text(entry) + ",\n";
  return out + "}\n";
}

std::string Look::line() const {
  std::vector<std::string> parts;
  for (const auto& entry : entries) parts.push_back(entry_text(entry));
  return join(parts);
}

Result<Look> look_of_preset(const std::filesystem::path& preset, const PresetOptions& options, Size size,
                            Diagnostics& diagnostics) {
  ShaderLibrary shaders(search_path_for(preset, options.paths));
  AFTERGLOW_TRY(Preset loaded, Preset::load(preset, options, shaders, diagnostics));
  BuildContext context{.size = size, .auxiliary = {{"depth", size}, {"normal", size}, {"motion", size}}};
  AFTERGLOW_TRY(const Build build, loaded.evaluate(context, diagnostics));
  Look look;
  look.paths = loaded.path().user;
  for (const auto& entry : *build.entries) {
    if (!entry.enabled) continue;
    LookEntry one{.effect = entry.effect, .settings = {}, .at = entry.at, .order = entry.order};
    const auto& schema = loaded.schema(entry.effect);
    for (std::size_t i = 0; i < entry.settings.size(); ++i)
      if (!(entry.settings[i].second == schema.settings[i].default_value)) one.settings.push_back(entry.settings[i]);
    look.entries.push_back(std::move(one));
  }
  return look;
}

}  // namespace afterglow::stress
