// SPDX-License-Identifier: MIT
#include "edit/write_back_place.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/printable.h"
#include "edit/literal.h"
#include "script/explanation.h"
#include "script/schema.h"

namespace afterglow::script {
namespace {

/// Tokens [first, end) of an argument.
struct Range {
  std::size_t first = LuaText::kNone, end = 0;
  explicit operator bool() const { return first != LuaText::kNone; }
};

// The n-th argument, from 0, of the call whose arguments begin at token `open`.
Range argument_of(const LuaText& text, std::size_t open, std::size_t n) {
  if (!text.is(open, "(")) {
    if (n > 0) return {};
    return {open, text.partner(open) == LuaText::kNone ? open + 1 : text.partner(open) + 1};
  }
  std::size_t i = open + 1;
  for (std::size_t at = 0; i < text.size() && !text.is(i, ")"); ++at) {
    const std::size_t first = i;
    while (i < text.size() && !text.is(i, ",") && !text.is(i, ")")) {
      const std::size_t partner = text.partner(i);
      i = partner == LuaText::kNone || partner < i ? i + 1 : partner + 1;
    }
    if (at == n) return {first, i};
    if (text.is(i, ",")) ++i;
  }
  return {};
}

bool is_table(const LuaText& text, const Range& range) {
  return text.is(range.first, "{") && text.partner(range.first) != LuaText::kNone &&
         text.partner(range.first) + 1 == range.end;
}

std::size_t token_at(const LuaText& text, std::size_t offset) {
  std::size_t low = 0, high = text.size();
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    (text[middle].begin < offset ? low : high) = text[middle].begin < offset ? middle + 1 : middle;
  }
  return low;
}

Error computed(const LuaText& text, const std::string& file, const PresetEdit& edit, const Range& range) {
  const std::size_t begin = text[range.first].begin;
  const std::size_t end = text[std::max(range.end, range.first + 1) - 1].end();
  const std::string expression(text.text().substr(begin, end - begin));
  return {ErrorKind::script,
          fmt::format("{} is computed and stays as it is: {}", edit.name(), tidy_message(expression, 80)), file,
          text[range.first].line};
}

// Calls of that name first, then all others that such a line has: functions go by other names too.
std::vector<Place> calls_at(const LuaText& text, int line, const std::string& name) {
  constexpr std::size_t kMost = 16;  // each costs a load of the preset
  std::vector<Place> out;
  for (const bool named : {true, false})
    for (const auto& call : text.calls())
      if (call.at(line) && (call.callee == name) == named && out.size() < kMost &&
          (named || !out.size() || text.is(call.open, "{")))
        out.push_back({text[call.open].begin, 0, {}});
  return out;
}

// How fx.extend's table calls the entry: by its name, or by its effect's where that is there and means this one alone.
std::string key_of(const LuaText& text, std::size_t table, const Preset& preset, const StackEntry& entry) {
  if (find_item(text, table, entry.name) || !find_item(text, table, entry.effect)) return entry.name;
  const auto& entries = preset.entries();
  const bool alone = std::ranges::count(entries, entry.effect, &StackEntry::effect) == 1;
  return alone ? entry.effect : entry.name;
}

std::vector<Place> extends_in(const LuaText& text, const Preset& preset, const StackEntry& entry) {
  std::vector<Place> out;
  for (const auto& call : text.calls()) {
    if (call.callee != "extend") continue;
    const Range table = argument_of(text, call.open, 1);
    const bool readable = table && is_table(text, table);
    out.push_back({text[call.open].begin, 1, {readable ? key_of(text, table.first, preset, entry) : entry.name}});
  }
  std::reverse(out.begin(), out.end());  // the last one is most likely the stack's
  return out;
}

// The value inside tables that the text lacks: { glow = { knee = 1 } }.
std::string nested(const std::vector<std::string>& keys, std::size_t from, std::string value) {
  for (std::size_t i = keys.size(); i-- > from;) {
    const LuaText key(keys[i]);
    const bool plain = key.size() == 1 && key[0].kind == TokenKind::name;
    value = fmt::format("{{ {} = {} }}", plain ? keys[i] : "[\"" + keys[i] + "\"]", value);
  }
  return value;
}

Change made(Replacements replacements, std::string before, std::string after, std::size_t fallback) {
  Change change{std::move(replacements), fallback, std::move(before), std::move(after)};
  // The last piece holds the value; those before it move it.
  std::size_t moved = 0;
  for (const auto& part : change.replacements) {
    const std::size_t inside = change.after.empty() ? std::string::npos : part.text.rfind(change.after);
    if (inside != std::string::npos) change.at = part.offset + moved + inside;
    moved += part.text.size() - part.length;
  }
  return change;
}

struct Found {
  std::size_t table = LuaText::kNone;  // innermost table that is there
  std::size_t depth = 0;               // how much of the path leads to it
  std::optional<LuaText::Item> item;   // the setting in it
};

// Follows the path, which ends in the setting itself. Errors: an expression where a table should be.
Result<Found> follow(const LuaText& text, const std::string& file, const Place& place, const PresetEdit& edit,
                     const std::vector<std::string>& path) {
  Found found;
  const Range argument = argument_of(text, token_at(text, place.offset), place.argument);
  if (!argument) return found;
  if (!is_table(text, argument)) return computed(text, file, edit, argument);
  found.table = argument.first;
  for (; found.depth + 1 < path.size(); ++found.depth) {
    const auto item = find_item(text, found.table, path[found.depth]);
    if (!item) return found;
    if (!text.is_table(*item)) return computed(text, file, edit, {item->value, item->end});
    found.table = item->value;
  }
  found.item = find_item(text, found.table, path.back());
  if (found.item && !is_literal(text, found.item->value, found.item->end))
    return computed(text, file, edit, {found.item->value, found.item->end});
  return found;
}

std::string source_of(const LuaText& text, const LuaText::Item& item) {
  const std::size_t begin = text[item.value].begin;
  return std::string(text.text().substr(begin, text[item.end - 1].end() - begin));
}

Change replace_value(const LuaText& text, const LuaText::Item& item, const SettingValue& value) {
  const std::string before = source_of(text, item);
  std::string after = literal_like(text, item.value, item.end, value);
  const std::size_t begin = text[item.value].begin;
  return made({{begin, before.size(), after}}, before, after, begin);
}

// Quotes and spaces as the script has them elsewhere.
std::string new_literal(const LuaText& text, const SettingValue& value) {
  char quote = '"';
  bool spaced = true;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i].kind == TokenKind::text && text[i].text[0] != '[') quote = text[i].text[0];
    if (text.is(i, "{") && text.partner(i) != LuaText::kNone && text.partner(i) > i + 1)
      spaced = text[i].end() != text[i + 1].begin;
  }
  return literal_text(value, quote, spaced);
}

}  // namespace

Result<std::vector<Place>> places_of(const LuaText& text, const Preset& preset, const std::string& file,
                                     const PresetEdit& edit) {
  const auto elsewhere = [&](const std::string& what, const std::string& where, int line) {
    return Error{ErrorKind::script,
                 fmt::format("{}: {} is made here, not in {}, which alone is changed", edit.name(), what, file), where,
                 line};
  };
  const auto& entries = preset.entries();
  const auto entry = std::ranges::find(entries, edit.entry, &StackEntry::name);
  if (entry == entries.end()) return Error{ErrorKind::usage, fmt::format("the stack has no entry '{}'", edit.entry)};
  std::vector<Place> places;
  if (!edit.volume.empty()) {
    const auto& volumes = preset.explanation().volumes;
    const auto volume = std::ranges::find(volumes, edit.volume, &VolumeState::name);
    if (volume == volumes.end())
      return Error{ErrorKind::usage, fmt::format("the stack has no volume '{}'", edit.volume)};
    if (volume->file != file) return elsewhere("the volume", volume->file, volume->line);
    for (Place& place : calls_at(text, volume->line, "volume")) {
      std::string key = entry->name;
      const Range table = argument_of(text, token_at(text, place.offset), 0);
      if (table && is_table(text, table))
        if (const auto settings = find_item(text, table.first, "settings"); settings && text.is_table(*settings))
          key = key_of(text, settings->value, preset, *entry);
      place.path = {"settings", key};
      places.push_back(std::move(place));
    }
    return places;
  }
  if (const auto [part, name] = split_mask_setting(edit.setting); entry->mask && !part.empty())
    for (const EntryMask* mask : entry->mask->parts())
      if (mask->part == part) {
        if (mask->file != file) return elsewhere("the mask", mask->file, mask->line);
        return calls_at(text, mask->line, mask->name);
      }
  places = entry->file == file ? calls_at(text, entry->line, entry->effect) : extends_in(text, preset, *entry);
  if (places.empty()) return elsewhere("the entry", entry->file, entry->line);
  return places;
}

std::size_t table_of(const LuaText& text, const Place& place) {
  const Range argument = argument_of(text, token_at(text, place.offset), place.argument);
  return argument && is_table(text, argument) ? argument.first : LuaText::kNone;
}

Result<Change> write_at(const LuaText& text, const std::string& file, const Place& place, const PresetEdit& edit,
                        const SettingValue& value) {
  std::vector<std::string> path = place.path;
  path.push_back(split_mask_setting(edit.setting).second);
  AFTERGLOW_TRY(const Found found, follow(text, file, place, edit, path));
  if (found.item) return replace_value(text, *found.item, value);
  const std::string literal = new_literal(text, value);
  if (found.table != LuaText::kNone) {
    const std::string& key = path[found.depth];
    return made(insert_item(text, found.table, key, nested(path, found.depth + 1, literal)), "", literal, place.offset);
  }
  const std::size_t open = token_at(text, place.offset);
  const std::size_t close = text.is(open, "(") ? text.partner(open) : LuaText::kNone;
  if (close == LuaText::kNone)
    return Error{
        ErrorKind::script,
        fmt::format("{}: the call here has no table to write it into; write ( ) around its arguments", edit.name()),
        file, text[open].line};
  const std::string table = nested(path, 0, literal);
  const std::size_t at = text[close - 1].end();
  return made({{at, 0, close == open + 1 ? table : ", " + table}}, "", literal, place.offset);
}

Result<Change> remove_at(const LuaText& text, const std::string& file, const Place& place, const PresetEdit& edit,
                         const SettingValue& otherwise) {
  std::vector<std::string> path = place.path;
  path.push_back(split_mask_setting(edit.setting).second);
  AFTERGLOW_TRY(const Found found, follow(text, file, place, edit, path));
  if (!found.item) return Change{};
  auto removed = remove_item(text, found.table, *found.item);
  if (!removed) return replace_value(text, *found.item, otherwise);
  return made(std::move(*removed), source_of(text, *found.item), "", place.offset);
}

}  // namespace afterglow::script
