// SPDX-License-Identifier: MIT
#include "stress/look.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "script/build.h"
#include "stress/auxiliary.h"

namespace afterglow::stress {
namespace {

std::string entry_text(const LookEntry& entry) {
  std::vector<std::string> keys;
  if (!entry.at.empty()) keys.push_back(fmt::format("at = \"{}\", order = {}", entry.at, entry.order));
  for (const auto& [name, value] : entry.settings) keys.push_back(fmt::format("{} = {}", name, value.text()));
  for (const auto& [name, value] : entry.composition) keys.push_back(fmt::format("{} = {}", name, value));
  return join(keys);
}

/// How many entries behind this one stand in it.
std::size_t members_of(const std::vector<LookEntry>& entries, std::size_t group) {
  std::size_t end = group + 1;
  while (end < entries.size() && entries[end].depth > entries[group].depth) ++end;
  return end - group - 1;
}

/// Entries from `begin` to `end` as items of a list.
std::vector<std::string> items(const std::vector<LookEntry>& entries, std::size_t begin, std::size_t end) {
  std::vector<std::string> out;
  for (std::size_t i = begin; i < end;) {
    const std::size_t behind = std::min(end, i + 1 + members_of(entries, i));
    std::vector<std::string> parts;
    if (const std::string keys = entry_text(entries[i]); !keys.empty()) parts.push_back(keys);
    for (auto& member : items(entries, i + 1, behind)) parts.push_back(std::move(member));
    out.push_back(parts.empty() ? fmt::format("fx.{} {{}}", entries[i].effect)
                                : fmt::format("fx.{} {{ {} }}", entries[i].effect, join(parts)));
    i = behind;
  }
  return out;
}

/// As a preset writes it.
std::string mask_text(const EntryMask& mask) {
  using Kind = EntryMask::Kind;
  if (mask.kind == Kind::number) return number_text(mask.number);
  if (mask.kind != Kind::named) {
    const char* sign = mask.kind == Kind::add ? "+" : mask.kind == Kind::subtract ? "-" : "*";
    return fmt::format("({} {} {})", mask_text(*mask.a), sign, mask_text(*mask.b));
  }
  std::vector<std::string> keys;
  for (const auto& [name, value] : mask.settings) keys.push_back(fmt::format("{} = {}", name, value.text()));
  return fmt::format("fx.mask.{} {{ {} }}", mask.name, join(keys));
}

/// How an entry is put over what it was given, where that is not the plain way.
std::vector<std::pair<std::string, std::string>> composition_of(const StackEntry& entry) {
  std::vector<std::pair<std::string, std::string>> out;
  if (entry.opacity != 1) out.emplace_back("opacity", number_text(entry.opacity));
  if (entry.blend != "normal") out.emplace_back("blend", "\"" + entry.blend + "\"");
  if (entry.mask) out.emplace_back("mask", mask_text(*entry.mask));
  return out;
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
  for (const auto& item : items(entries, 0, entries.size())) out += "  " + item + ",\n";
  return out + "}\n";
}

std::string Look::line() const { return join(items(entries, 0, entries.size())); }

bool Look::is_composed() const {
  return std::ranges::any_of(entries, [](const LookEntry& e) { return !e.composition.empty() || e.effect == kGroup; });
}

Look Look::without(std::size_t entry) const {
  Look out = *this;
  const std::size_t members = members_of(entries, entry);
  for (std::size_t i = 1; i <= members; ++i) --out.entries[entry + i].depth;
  out.entries.erase(out.entries.begin() + static_cast<std::ptrdiff_t>(entry));
  return out;
}

Result<Look> look_of_preset(const std::filesystem::path& preset, const PresetOptions& options, Size size,
                            Diagnostics& diagnostics) {
  ShaderLibrary shaders(search_path_for(preset, options.paths));
  AFTERGLOW_TRY(Preset loaded, Preset::load(preset, options, shaders, diagnostics));
  BuildContext context{.size = size, .auxiliary = auxiliary_sizes(size)};
  AFTERGLOW_TRY(const Build build, loaded.evaluate(context, diagnostics));
  Look look;
  look.paths = loaded.path().user;
  const auto warn = [&](const std::string& what) { diagnostics.warn(fmt::format("{}: {}", preset.string(), what)); };
  if (loaded.may_change()) warn("settings that move are tried as they are in the first frame");
  for (std::size_t i = 0; i < build.entries->size(); ++i) {
    const StackEntry& entry = (*build.entries)[i];
    if (!entry.enabled) {
      i += static_cast<std::size_t>(entry.members);
      continue;
    }
    LookEntry one{.effect = entry.effect, .settings = {}, .at = entry.at, .order = entry.order};
    one.composition = composition_of(entry);
    one.depth = entry.depth;
    if (entry.is_mix()) {
      warn(fmt::format("'{}' is tried as a group: the effects of both looks, one behind the other", entry.name));
      one.effect = kGroup;
    } else {
      const auto& schema = loaded.schema(entry.effect);
      for (std::size_t k = 0; k < entry.settings.size(); ++k)
        if (!(entry.settings[k].second == schema.settings[k].default_value)) one.settings.push_back(entry.settings[k]);
    }
    look.entries.push_back(std::move(one));
  }
  return look;
}

}  // namespace afterglow::stress
