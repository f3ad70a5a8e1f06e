// SPDX-License-Identifier: MIT
#include "apps/effect_page.h"

#include <fmt/format.h>

#include <sstream>

#include "apps/setting_text.h"
#include "core/file.h"
#include "core/text.h"

namespace afterglow {
namespace {

/// The lines of comment that a script begins with, without their dashes and without the one that names its licence.
std::string head_comment(const std::filesystem::path& file) {
  const auto text = read_file(file);
  if (!text.ok()) return {};
  std::istringstream lines(*text);
  std::string comment;
  for (std::string line; std::getline(lines, line) && line.starts_with("--");)
    if (!line.starts_with("-- SPDX-")) comment += line.substr(line.starts_with("-- ") ? 3 : 2) + "\n";
  return comment;
}

/// Text for a cell of a table.
std::string cell(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '|') out += '\\';
    out += c;
  }
  return out;
}

}  // namespace

std::string space_text(const EffectSchema& effect) {
  if (effect.space_by_settings) return "Which light it is made for depends on its settings.";
  const LightSpace needs = effect.space.needs, makes = effect.space.makes;
  if (needs == LightSpace::any && makes == LightSpace::any) return "Works on any light.";
  if (makes == LightSpace::any) return fmt::format("Made for {} light.", space_name(needs));
  return fmt::format("Takes {}{} light, makes {} light.", needs == LightSpace::any ? "" : space_name(needs),
                     needs == LightSpace::any ? "any" : "", space_name(makes));
}

std::string inputs_text(const EffectSchema& effect) {
  std::vector<std::string> parts;
  for (const auto& [verb, list] : {std::pair("Needs", &effect.needs), std::pair("Uses", &effect.optional)})
    if (!list->names.empty()) parts.push_back(fmt::format("{} {}.", verb, join(list->names)));
  for (const auto& [verb, list] : {std::pair("needs", &effect.needs), std::pair("uses", &effect.optional)})
    if (list->by_settings) parts.push_back(fmt::format("Which inputs it {} depends on its settings.", verb));
  return join(parts, " ");
}

std::string effect_page(const EffectSchema& effect) {
  std::string out = fmt::format("## {}\n\n{}\n\n", effect.name, effect.doc);
  if (const auto notes = head_comment(effect.file); !notes.empty()) out += notes + "\n";
  const std::string inputs = inputs_text(effect);
  out += fmt::format("Runs at `{}`, order {}. {}{}{}\n\n", effect.at, effect.order, space_text(effect),
                     inputs.empty() ? "" : " ", inputs);
  if (effect.settings.empty()) return out;
  out += "| setting | type | allowed | default | what it does |\n|---|---|---|---|---|\n";
  for (const auto& setting : effect.settings)
    out += fmt::format("| `{}` | {} | {} | `{}` | {} |\n", setting.name, type_text(setting.type),
                       cell(allowed_text(setting)), setting.default_value.text(), cell(setting.doc));
  return out + "\n";
}

}  // namespace afterglow
