// SPDX-License-Identifier: MIT
#include "edit/stack_shape.h"

#include <fmt/format.h>

#include "script/explanation.h"

namespace afterglow::script {
namespace {

void add_setting(std::string& out, const SettingHistory& setting) {
  out += fmt::format("{} = {} {}", setting.name, setting.kind, setting.preset.value_or(setting.default_value).text());
  for (const auto& step : setting.volumes)
    out += fmt::format(", {} × {}: {}", step.volume, step.factor, step.value.text());
  out += "\n";
}

EntryShape shape_of_entry(const StackEntry& entry, const EntryHistory& history) {
  EntryShape shape{
      .name = entry.name, .said = {}, .mask = {}, .place = {}, .members = entry.members, .depth = entry.depth};
  shape.said = fmt::format("{} {} {} {}\n", entry.effect, entry.enabled, entry.required, entry.can_lack);
  for (const auto& setting : history.settings) add_setting(shape.said, setting);
  if (entry.mask) shape.mask = entry.mask->text() + "\n";
  for (const auto& setting : history.composition)
    add_setting(setting.name.starts_with("mask.") ? shape.mask : shape.said, setting);
  shape.place = entry.members == 0 ? fmt::format("{} {}", entry.at, entry.order) : entry.at;
  return shape;
}

}  // namespace

StackShape shape_of(const Preset& preset) {
  StackShape out;
  const auto& histories = preset.explanation().entries;
  for (std::size_t i = 0; i < preset.entries().size() && i < histories.size(); ++i)
    out.push_back(shape_of_entry(preset.entries()[i], histories[i]));
  return out;
}

std::size_t unit_end(const StackShape& shape, std::size_t i) {
  return i + 1 + static_cast<std::size_t>(shape[i].members);
}

std::optional<std::size_t> neighbour_of(const Preset& preset, std::size_t i, bool later) {
  const auto& entries = preset.entries();
  const auto end_of = [&](std::size_t at) { return entries[at].end_of(at); };
  // The list that it stands in: of the whole stack, of the group around it, of one look of a mix.
  std::size_t first = 0, last = entries.size();
  for (std::size_t p = 0; p < i; ++p) {
    if (entries[p].depth + 1 != entries[i].depth || end_of(p) <= i) continue;
    first = p + 1;
    last = end_of(p);
    const std::size_t middle = entries[p].middle_of(p);
    if (middle > first) (i < middle ? last : first) = middle;
  }
  if (later) return end_of(i) < last ? std::optional(end_of(i)) : std::nullopt;
  for (std::size_t at = first; at < i; at = end_of(at))
    if (end_of(at) == i) return at;
  return std::nullopt;
}

bool same_stack(const StackShape& before, const StackShape& after, std::size_t any_place) {
  if (before.size() != after.size()) return false;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const EntryShape &a = before[i], &b = after[i];
    if (a.said != b.said || a.mask != b.mask || a.depth != b.depth) return false;
    if (i != any_place && a.place != b.place) return false;
  }
  return true;
}

std::vector<std::pair<std::string, std::string>> renamed(const StackShape& before, const StackShape& after) {
  std::vector<std::pair<std::string, std::string>> out;
  for (std::size_t i = 0; i < before.size() && i < after.size(); ++i)
    if (!before[i].name.empty()) out.emplace_back(before[i].name, after[i].name);
  return out;
}

}  // namespace afterglow::script
