// SPDX-License-Identifier: MIT
#include "script/items.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "core/text.h"
#include "script/entry_reader.h"
#include "script/injection.h"
#include "script/native.h"
#include "script/object.h"

namespace afterglow::script {
namespace {

constexpr std::size_t kMaxItems = 1024;    // of one state
constexpr std::size_t kMaxMembers = 8192;  // of all groups
constexpr int kMaxDepth = 32;              // of lists in lists
constexpr std::uint64_t kItemCost = 16;    // instructions of the sandbox

void add_group(const DeclaredGroup& group, std::vector<DeclaredEntry>& entries) {
  entries.push_back(group.entry);
  entries.insert(entries.end(), group.members.begin(), group.members.end());
}

class ItemReader {
 public:
  ItemReader(lua_State* lua, TableReader& table, std::vector<DeclaredEntry>& entries,
             std::vector<DeclaredVolume>* volumes)
      : lua_(lua), table_(table), entries_(entries), volumes_(volumes) {}

  void read(const TableReader& list, const KeyPath& place, int depth) {
    Runtime::of(lua_).box->charge(kItemCost * (list.keys().size() + 1));
    for (const auto& key : list.keys()) {
      KeyPath at = place;
      at.push_back(key.name);
      if (key.position == 0) {
        if (depth > 0)
          table_.fail(failure(fmt::format("{}: a list in it has a name, '{}'", table_.what(), key.name), at));
        continue;
      }
      if (entries_.size() > kMaxItems) throw failure(fmt::format("more than {} effects in one preset", kMaxItems));
      list.push(key);
      item(key, at, depth);
      lua_pop(lua_, 1);
    }
  }

 private:
  void item(const TableReader::Key& key, const KeyPath& at, int depth) {
    const Runtime& runtime = Runtime::of(lua_);
    const Handle* volume = volumes_ ? to_object<Handle>(lua_, -1, kVolumeKind) : nullptr;
    const std::string place = fmt::format("{}: position {} is", table_.what(), key.position);
    const std::string allowed = volumes_
                                    ? "fx.NAME { … }, fx.group { … }, fx.mix { … }, fx.volume { … }, a list of them"
                                    : "fx.NAME { … }, a stack, a list of them";
    if (const Handle* entry = to_object<Handle>(lua_, -1, kEntryKind)) {
      entries_.push_back(runtime.entries[static_cast<std::size_t>(entry->index)]);
    } else if (const Handle* group = to_object<Handle>(lua_, -1, kGroupKind)) {
      add_group(runtime.groups[static_cast<std::size_t>(group->index)], entries_);
    } else if (volume) {
      volumes_->push_back(runtime.volumes[static_cast<std::size_t>(volume->index)]);
    } else if (const Handle* stack = volumes_ ? nullptr : to_object<Handle>(lua_, -1, kStackKind)) {
      add_stack(runtime.stacks[static_cast<std::size_t>(stack->index)], at);
    } else if (lua_isboolean(lua_, -1) && !lua_toboolean(lua_, -1)) {
      return;
    } else if (lua_istable(lua_, -1) && depth < kMaxDepth) {
      const void* const own = lua_topointer(lua_, -1);
      if (std::ranges::find(around_, own) != around_.end())
        throw failure(fmt::format("{}: position {} is a list that holds itself", table_.what(), key.position), at);
      around_.push_back(own);
      const TableReader list(lua_, -1, table_.what());
      read(list, at, depth + 1);
      around_.pop_back();
    } else if (to_object<Handle>(lua_, -1, kStackKind)) {
      table_.fail(failure(place + " a stack, which goes into fx.group { … } here", at, allowed));
    } else if (to_object<Handle>(lua_, -1, kEffectKind)) {
      table_.fail(failure(place + " the effect itself, which belongs into the file effects/NAME.lua", at, allowed));
    } else if (lua_iscfunction(lua_, -1)) {
      table_.fail(failure(place + " an effect without settings", at, allowed));
    } else {
      table_.fail(failure(
          fmt::format("{} {}, not an effect{}", place, read_value(lua_, -1).shown(), volumes_ ? " or a volume" : ""),
          at, allowed));
    }
  }

  // The entries of a whole look. Its volumes and position stay behind: they are a stack's.
  void add_stack(const DeclaredStack& stack, const KeyPath& at) {
    if (!stack.volumes.empty())
      table_.fail(failure(fmt::format("{}: a look with volumes cannot stand in a group or a mix", table_.what()), at));
    for (const auto& [key, given] : {std::pair{"input_space", !stack.input_space.empty()},
                                     {"gamut", !stack.gamut.empty()},
                                     {"alpha", !stack.alpha.empty()},
                                     {"reference_height", stack.reference_height.has_value()}})
      if (given) {
        Error place;
        const Sandbox& box = *Runtime::of(lua_).box;
        box.locate(place, box.caller(lua_));
        const std::string told =
            fmt::format("{}:{}: {}: the '{}' of the look in it does not count; that of the outer stack does",
                        place.file, place.line, table_.what(), key);
        Runtime::of(lua_).box->diagnostics->warn_once(told, told);
      }
    for (DeclaredEntry entry : stack.entries) {
      entry.name.reset();  // names are given anew: the same look may stand here twice
      entries_.push_back(std::move(entry));
    }
  }

  lua_State* lua_;
  TableReader& table_;
  std::vector<DeclaredEntry>& entries_;
  std::vector<DeclaredVolume>* volumes_;
  std::vector<const void*> around_{};  ///< lists that the one being read is in
};

std::ptrdiff_t point_index(const std::string& at) {
  const auto& points = injection_points();
  return std::find(points.begin(), points.end(), at) - points.begin();
}

bool runs_before(const StackEntry& a, const StackEntry& b) {
  const auto point_a = point_index(a.at), point_b = point_index(b.at);
  return point_a != point_b ? point_a < point_b : a.order < b.order;
}

using Entries = std::vector<DeclaredEntry>;

Entries sorted(Entries entries, int depth) {
  struct Unit {
    Entries entries;    // a group's come with it
    std::size_t place;  // in the list as it is written
  };
  std::vector<Unit> units;
  for (std::size_t i = 0; i < entries.size();) {
    DeclaredEntry head = std::move(entries[i]);
    head.entry.depth = depth;
    const auto from = entries.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    const std::ptrdiff_t middle = head.entry.middle, members = head.entry.members;
    Entries first = sorted(Entries(from, from + middle), depth + 1);
    Entries rest = sorted(Entries(from + middle, from + members), depth + 1);
    const StackEntry* earliest = nullptr;
    for (const Entries* part : {&first, &rest})
      if (!part->empty() && (!earliest || runs_before(part->front().entry, *earliest))) earliest = &part->front().entry;
    if (earliest && !head.says_at) head.entry.at = earliest->at;
    if (earliest && !head.says_order) head.entry.order = earliest->order;
    i += static_cast<std::size_t>(members) + 1;
    Entries unit{std::move(head)};
    for (Entries* part : {&first, &rest}) std::ranges::move(*part, std::back_inserter(unit));
    units.push_back({std::move(unit), units.size()});
  }
  const auto head = [](const Unit& unit) -> const StackEntry& { return unit.entries.front().entry; };
  std::ranges::stable_sort(units, [&](const Unit& a, const Unit& b) { return runs_before(head(a), head(b)); });
  Entries out;
  for (auto unit = units.begin(); unit != units.end(); ++unit) {
    const auto overtaken = std::find_if(unit + 1, units.end(), [&](const Unit& other) {
      return other.place < unit->place && head(other).file == head(*unit).file;
    });
    if (overtaken != units.end()) unit->entries.front().entry.overtakes = head(*overtaken).name;
    std::ranges::move(unit->entries, std::back_inserter(out));
  }
  return out;
}

// The entry that stands for a group; its settings are those of `schema`.
DeclaredEntry entry_of(Runtime& runtime, const EffectSchema& schema) {
  auto known = runtime.effect_by_name.find(schema.name);
  if (known == runtime.effect_by_name.end()) {
    Effect effect;
    effect.schema = schema;
    runtime.effects.push_back(std::move(effect));
    known = runtime.effect_by_name.emplace(schema.name, static_cast<int>(runtime.effects.size()) - 1).first;
  }
  return new_entry(runtime, known->second);
}

int declare(lua_State* lua, const EffectSchema& schema, const char* function, bool two) {
  Runtime& runtime = Runtime::of(lua);
  const std::string what = std::string("fx.") + function;
  if (!runtime.declaring) throw failure(what + " can only be used while a script loads");
  if (runtime.groups.size() >= kMaxItems) throw failure("too many groups");
  TableReader table(lua, 1, what);
  DeclaredGroup group{entry_of(runtime, schema), {}};
  StackEntry& entry = group.entry.entry;
  read_entry_keys(lua, table, schema, group.entry);
  for (const auto& key : table.keys()) {
    if (key.position > 0 || std::ranges::find(entry_keys(), key.name) != entry_keys().end()) continue;
    const bool known = std::ranges::find(schema.settings, key.name, &SettingSchema::name) != schema.settings.end();
    std::vector<std::string> names = entry_keys();
    for (const auto& setting : schema.settings) names.push_back(setting.name);
    if (!known)
      table.fail(failure(fmt::format("{} has no '{}'", what, key.name), {key.name}, join(names),
                         nearest_name(key.name, names)));
  }
  std::vector<std::string> positions;
  for (const auto& key : table.keys())
    if (key.position > 0) positions.push_back(key.name);
  if (two) {
    std::vector<std::string> others = entry_keys();
    others.insert(others.end(), positions.begin(), positions.end());
    read_settings_of(lua, table, schema, group.entry, others);
    if (positions.size() != 2)
      table.fail(failure(fmt::format("{} has {} looks", what, positions.size()), {},
                         "two: each a stack, a group, an effect or a list of effects"));
    for (const auto& key : table.keys()) {
      if (key.position == 0 || key.position > 2) continue;
      lua_createtable(lua, 1, 0);
      table.push(key);
      lua_rawseti(lua, -2, 1);
      TableReader look(lua, -1, what, table, {});
      read_items(lua, look, group.members, nullptr);
      lua_pop(lua, 1);
      if (key.position == 1) entry.middle = static_cast<int>(group.members.size());
    }
  } else {
    read_items(lua, table, group.members, nullptr);
  }
  table.finish(function);
  entry.members = static_cast<int>(group.members.size());
  Error place;
  runtime.box->locate(place, runtime.box->caller(lua));
  entry.file = place.file;
  entry.line = place.line;
  runtime.group_members += group.members.size();
  if (runtime.group_members > kMaxMembers) throw failure(fmt::format("more than {} effects in groups", kMaxMembers));
  runtime.groups.push_back(std::move(group));
  push_object(lua, kGroupKind, Handle{static_cast<int>(runtime.groups.size()) - 1});
  return 1;
}

}  // namespace

void read_items(lua_State* lua, TableReader& table, std::vector<DeclaredEntry>& entries,
                std::vector<DeclaredVolume>* volumes) {
  ItemReader(lua, table, entries, volumes).read(table, {}, 0);
}

void sort_entries(std::vector<DeclaredEntry>& entries) { entries = sorted(std::move(entries), 0); }

int declare_group(lua_State* lua) {
  EffectSchema schema;
  schema.name = "group";
  schema.at = "post_process";
  return declare(lua, schema, "group", false);
}

int declare_mix(lua_State* lua) {
  EffectSchema schema;
  schema.name = "mix";
  schema.at = "post_process";
  SettingSchema amount;
  amount.name = "amount";
  amount.doc = "Share of the second look.";
  amount.min = 0;
  amount.max = 1;
  amount.default_value.number[0] = 0.5;
  schema.settings.push_back(std::move(amount));
  return declare(lua, schema, "mix", true);
}

}  // namespace afterglow::script
