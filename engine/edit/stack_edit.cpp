// SPDX-License-Identifier: MIT
#include "edit/stack_edit.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "edit/stack_place.h"
#include "edit/stack_shape.h"
#include "edit/table_edit.h"
#include "edit/write_back_check.h"
#include "edit/write_back_place.h"

namespace afterglow {

using namespace script;

namespace {

using Kind = StackEdit::Kind;

/// A text that may be the wanted one, with the stack that it makes.
struct Trial {
  std::string text;
  Preset preset;
  StackShape shape;
};

class StackRewriter {
 public:
  StackRewriter(const std::filesystem::path& file, const std::string& text, const StackEdit& edit,
                const PresetOptions& options, const Preset& preset)
      : file_(file),
        text_(text),
        edit_(edit),
        options_(options),
        preset_(preset),
        lua_(text_),
        shape_(shape_of(preset)) {}

  Result<StackRewrite> run() {
    if (edit_.kind == Kind::add) return add();
    const auto& entries = preset_.entries();
    const auto found = std::ranges::find(entries, edit_.name, &StackEntry::name);
    if (found == entries.end()) {
      std::vector<std::string> names;
      for (const auto& entry : entries) names.push_back(entry.name);
      return Error{ErrorKind::usage,
                   fmt::format("the stack has no entry '{}'", edit_.name),
                   "",
                   0,
                   join(names),
                   nearest_name(edit_.name, names)};
    }
    const auto at = static_cast<std::size_t>(found - entries.begin());
    if (found->file != file_.string() && edit_.kind != Kind::mask) return elsewhere(*found);
    switch (edit_.kind) {
      case Kind::remove:
        return remove(at);
      case Kind::duplicate:
        return duplicate(at);
      case Kind::mask:
        return mask(at);
      default:
        return move(at);
    }
  }

 private:
  Result<StackRewrite> add() {
    // What the effect is by itself: it may not exist, or not do without settings.
    const std::string call = fmt::format("{}.{} {{}}", library_name(lua_), edit_.name);
    const auto alone = load_text(
        file_, fmt::format("local fx = require \"afterglow\"\nreturn fx.stack {{ fx[\"{}\"] {{}} }}\n", edit_.name),
        options_);
    if (!alone) {
      Error error = alone.error();
      if (error.file == file_.string()) error.file.clear(), error.line = 0;  // lines of that text, not of the file
      return error;
    }
    const StackShape wanted = shape_of(*alone);
    for (const std::size_t open : tables()) {
      auto trial = tried(replaced(text_, insert_last(open, call)));
      const auto at = trial ? added(*trial, wanted) : std::nullopt;
      if (!at) continue;
      // Behind what runs before it, so that the text reads as it runs; else at the end of the list.
      if (*at > 0)
        if (auto nearer = behind(*at - 1, call, wanted)) return std::move(*nearer);
      return done(*trial, with_new(*at), *at);
    }
    return refuse("no list of effects is written out in this file: the script makes the stack", nullptr);
  }

  std::optional<StackRewrite> behind(std::size_t before, const std::string& call, const StackShape& wanted) {
    std::size_t unit = before;
    for (std::size_t i = 0; i <= before; i = unit_end(shape_, i)) unit = i;
    const StackEntry& entry = preset_.entries()[unit];
    if (entry.file != file_.string()) return {};
    for (const ListPlace& place : list_places(lua_, entry)) {
      auto trial = tried(replaced(text_, insert_behind(lua_, place.open, place.index, call)));
      if (const auto at = trial ? added(*trial, wanted) : std::nullopt) return done(*trial, with_new(*at), *at);
    }
    return {};
  }

  /// Where the new entry stands when all others are as before.
  std::optional<std::size_t> added(const Trial& trial, const StackShape& wanted) const {
    if (wanted.size() != 1 || trial.shape.size() != shape_.size() + 1) return {};
    for (std::size_t at = 0; at < trial.shape.size(); ++at) {
      if (!same_stack(wanted, {trial.shape[at]})) continue;
      StackShape rest = trial.shape;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(at));
      if (same_stack(shape_, rest)) return at;
    }
    return {};
  }

  StackShape with_new(std::size_t at) const {
    StackShape out = shape_;
    out.insert(out.begin() + static_cast<std::ptrdiff_t>(at), EntryShape{});
    return out;
  }

  Replacements insert_last(std::size_t open, const std::string& call) const {
    const auto lists = list_items(lua_, open);
    const auto items = lua_.items(open);
    if (items.empty()) return insert_first(lua_, open, call);
    return insert_behind(lua_, open, lists.empty() ? items.size() - 1 : lists.back(), call);
  }

  /// Tables that an effect can be written into: arguments of a stack, else lists that hold entries.
  std::vector<std::size_t> tables() const {
    std::vector<std::size_t> out = stack_tables(lua_);
    for (const auto& entry : preset_.entries())
      if (entry.file == file_.string() && entry.depth == 0)
        for (const ListPlace& place : list_places(lua_, entry))
          if (std::ranges::find(out, place.open) == out.end()) out.push_back(place.open);
    constexpr std::size_t kMost = 8;
    if (out.size() > kMost) out.resize(kMost);
    return out;
  }

  Result<StackRewrite> remove(std::size_t at) {
    StackShape wanted = shape_;
    const auto begin = static_cast<std::ptrdiff_t>(at), end = static_cast<std::ptrdiff_t>(unit_end(shape_, at));
    wanted.erase(wanted.begin() + begin, wanted.begin() + end);
    return first_that(at, wanted, kNobody,
                      [&](const ListPlace& place) { return take_out(lua_, place.open, place.index); });
  }

  Result<StackRewrite> duplicate(std::size_t at) {
    StackShape wanted = shape_;
    const auto begin = static_cast<std::ptrdiff_t>(at), end = static_cast<std::ptrdiff_t>(unit_end(shape_, at));
    StackShape unit(wanted.begin() + begin, wanted.begin() + end);
    for (EntryShape& entry : unit) entry.name.clear();
    wanted.insert(wanted.begin() + end, unit.begin(), unit.end());
    return first_that(at, wanted, static_cast<std::size_t>(end), [&](const ListPlace& place) {
      const auto item = lua_.items(place.open)[place.index];
      const std::size_t from = lua_[item.value].begin;
      std::string copy = unnamed(text_.substr(from, lua_[item.end - 1].end() - from));
      return insert_behind(lua_, place.open, place.index, copy);
    });
  }

  /// Names are given once: the copy gets one of its own.
  static std::string unnamed(std::string source) {
    for (std::size_t open = 0;; ++open) {
      const LuaText lua(source);
      if (open >= lua.size()) return source;
      if (!lua.is(open, "{") || lua.partner(open) == LuaText::kNone) continue;
      const auto items = lua.items(open);
      const auto name = std::ranges::find(items, "name", &LuaText::Item::key);
      if (name == items.end()) continue;
      source = replaced(source, take_out(lua, open, static_cast<std::size_t>(name - items.begin())));
    }
  }

  Result<StackRewrite> mask(std::size_t at) {
    const StackEntry& entry = preset_.entries()[at];
    if (entry.mask && !edit_.mask.empty())
      return refuse(fmt::format("{} has a mask: {}; remove that one first", entry.name, entry.mask->text()), &entry);
    AFTERGLOW_TRY(const auto places, places_of(lua_, preset_, file_.string(), {entry.name, "enabled", {}, ""}));
    std::optional<Error> reason;
    for (const Place& place : places) {
      const std::size_t table = table_of(lua_, place);
      if (table == LuaText::kNone || !place.path.empty()) continue;
      const auto trial = tried(replaced(text_, mask_text(table)), &reason);
      if (!trial || trial->shape.size() != shape_.size()) continue;
      StackShape wanted = shape_;
      const auto& now = trial->preset.entries()[at].mask;
      const bool as_wanted = edit_.mask.empty() ? !now : now && now->text() == edit_.mask;
      wanted[at].mask = trial->shape[at].mask;
      if (as_wanted && same_stack(wanted, trial->shape)) return done(*trial, wanted, at);
    }
    if (reason) return *reason;
    return refuse(fmt::format("{} is made without a table of its own: its mask stays as it is", entry.name), &entry);
  }

  Replacements mask_text(std::size_t table) const {
    const std::string source = fmt::format("{}.mask.{} {{}}", library_name(lua_), edit_.mask);
    const auto items = lua_.items(table);
    const auto item = std::ranges::find(items, "mask", &LuaText::Item::key);
    if (item == items.end()) return edit_.mask.empty() ? Replacements{} : insert_item(lua_, table, "mask", source);
    return take_out(lua_, table, static_cast<std::size_t>(item - items.begin()));
  }

  Result<StackRewrite> move(std::size_t at) {
    const bool later = edit_.kind == Kind::later;
    const StackEntry& entry = preset_.entries()[at];
    const auto other = neighbour_of(preset_, at, later);
    if (!other)
      return Error{ErrorKind::usage, fmt::format("{} is the {} already", entry.name, later ? "last" : "first")};
    const StackEntry& next = preset_.entries()[*other];
    if (next.at != entry.at)
      return Error{ErrorKind::usage,
                   fmt::format("{} runs at {}, and {} at {}: entries move within their injection point", entry.name,
                               entry.at, next.name, next.at),
                   entry.file, entry.line};
    StackShape wanted = shape_;
    const auto place = [&](std::size_t i) { return wanted.begin() + static_cast<std::ptrdiff_t>(i); };
    const std::size_t low = std::min(at, *other), high = std::max(at, *other), end = unit_end(shape_, high);
    std::rotate(place(low), place(high), place(end));
    const std::size_t now = later ? at + (end - high) : *other;
    std::vector<std::optional<int>> orders;  // to try: the effect's own, then that of the other entry
    if (entry.members == 0 && entry.order != preset_.schema(entry.effect).order)
      orders.emplace_back(preset_.schema(entry.effect).order);
    orders.push_back(entry.order == next.order ? std::nullopt : std::optional(next.order));
    std::optional<Error> reason;
    for (const auto& order : orders) {
      const auto text = ordered(entry, order, reason);
      if (!text) continue;
      if (auto moved = placed(*text, at, *other, later, wanted, now)) return std::move(*moved);
    }
    if (reason) return *reason;
    return refuse(fmt::format("{} and {} do not stand in one list that is written out", entry.name, next.name), &entry);
  }

  /// The text with another order of the entry; as it is where there is none.
  std::optional<std::string> ordered(const StackEntry& entry, const std::optional<int>& order,
                                     std::optional<Error>& reason) const {
    if (!order) return text_;
    PresetEdit edit{entry.name, "order", SettingValue{SettingType::integer, {static_cast<double>(*order)}, ""}, ""};
    if (entry.members == 0 && *order == preset_.schema(entry.effect).order) edit.value.reset();
    const auto rewrite = rewrite_preset(file_, text_, {edit}, options_);
    if (!rewrite) reason = rewrite.error();
    if (rewrite && !rewrite->refused.empty()) reason = rewrite->refused[0].reason;
    if (!rewrite || !rewrite->refused.empty()) return {};
    return rewrite->text;
  }

  /// The text with the entry before or behind the other one in their list, where it does not stand there already.
  std::optional<StackRewrite> placed(const std::string& text, std::size_t at, std::size_t other, bool later,
                                     const StackShape& wanted, std::size_t now) const {
    auto start = tried(text);
    if (!start) return {};
    if (same_stack(wanted, start->shape, now)) return done(*start, wanted, now);
    // By name: another order may have put them elsewhere.
    const auto entry = [&](std::size_t i) {
      const auto& entries = start->preset.entries();
      return std::ranges::find(entries, shape_[i].name, &StackEntry::name);
    };
    const LuaText lua(text);
    const auto others = list_places(lua, *entry(other));
    for (const ListPlace& from : list_places(lua, *entry(at)))
      for (const ListPlace& to : others) {
        if (from.open != to.open || from.index == to.index || (from.index < to.index) != later) continue;
        const auto moved = move_item(lua, from.open, list_items(lua, from.open), from.index, to.index);
        const auto trial = tried(replaced(text, moved));
        if (trial && same_stack(wanted, trial->shape, now)) return done(*trial, wanted, now);
      }
    return {};
  }

  /// The first change of a place of the entry that makes the wanted stack.
  template <class Change>
  Result<StackRewrite> first_that(std::size_t at, const StackShape& wanted, std::size_t shown, const Change& change) {
    const StackEntry& entry = preset_.entries()[at];
    std::optional<Error> reason;
    for (const ListPlace& place : list_places(lua_, entry)) {
      const auto trial = tried(replaced(text_, change(place)), &reason);
      if (trial && same_stack(wanted, trial->shape)) return done(*trial, wanted, shown);
    }
    if (reason) return *reason;
    return refuse(fmt::format("{} is no item of a list that is written out: the script makes it", entry.name), &entry);
  }

  std::optional<Trial> tried(std::string text, std::optional<Error>* reason = nullptr) const {
    auto preset = load_text(file_, text, options_);
    auto same = preset ? check_stack(preset_, *preset) : Result<void>(preset.error());
    if (!same) {
      if (reason && !*reason) *reason = same.error();
      return {};
    }
    StackShape shape = shape_of(*preset);
    return Trial{std::move(text), std::move(*preset), std::move(shape)};
  }

  StackRewrite done(const Trial& trial, const StackShape& wanted, std::size_t shown) const {
    StackRewrite out{.text = trial.text, .entry = {}, .line = 0, .renamed = renamed(wanted, trial.shape)};
    if (shown < trial.shape.size()) {
      out.entry = trial.shape[shown].name;
      out.line = trial.preset.entries()[shown].line;
    }
    return out;
  }

  Error refuse(const std::string& why, const StackEntry* entry) const {
    return {ErrorKind::script, why, entry ? entry->file : file_.string(), entry ? entry->line : 0};
  }
  Error elsewhere(const StackEntry& entry) const {
    return refuse(
        fmt::format("{}: the entry is made here, not in {}, which alone is changed", entry.name, file_.string()),
        &entry);
  }

  const std::filesystem::path& file_;
  const std::string& text_;
  const StackEdit& edit_;
  const PresetOptions& options_;
  const Preset& preset_;
  const LuaText lua_;
  const StackShape shape_;
};

}  // namespace

Result<StackRewrite> rewrite_stack(const std::filesystem::path& file, const std::string& before, const StackEdit& edit,
                                   const PresetOptions& options) {
  AFTERGLOW_TRY(const Preset preset, load_text(file, before, options));
  return StackRewriter(file, before, edit, options, preset).run();
}

}  // namespace afterglow
