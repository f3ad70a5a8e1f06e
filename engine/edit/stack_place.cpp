// SPDX-License-Identifier: MIT
#include "edit/stack_place.h"

#include <algorithm>

namespace afterglow::script {
namespace {

constexpr std::size_t kMostPlaces = 16;  // each costs a load of the preset

using Call = LuaText::Call;

// The token behind the call's arguments.
std::size_t call_end(const LuaText& text, const Call& call) {
  const std::size_t partner = text.partner(call.open);
  return (partner == LuaText::kNone ? call.open : partner) + 1;
}

// The name of a local or global that the call's result is given to; empty: none.
std::string_view variable_of(const LuaText& text, const Call& call) {
  // Back over the called expression: `fx.name` before the arguments.
  std::size_t i = call.open;
  while (i > 0 && (text[i - 1].kind == TokenKind::name || text.is(i - 1, "."))) --i;
  if (i < 2 || !text.is(i - 1, "=") || text[i - 2].kind != TokenKind::name) return {};
  return text[i - 2].text;
}

bool has(const std::vector<ListPlace>& places, const ListPlace& place) {
  return std::ranges::any_of(places, [&](const auto& p) { return p.open == place.open && p.index == place.index; });
}

}  // namespace

std::vector<std::size_t> list_items(const LuaText& text, std::size_t open) {
  std::vector<std::size_t> out;
  const auto items = text.items(open);
  for (std::size_t i = 0; i < items.size(); ++i)
    if (items[i].first == items[i].value) out.push_back(i);
  return out;
}

std::vector<ListPlace> list_places(const LuaText& text, const StackEntry& entry) {
  std::vector<Call> named, others;
  for (const Call& call : text.calls())
    if (call.at(entry.line)) (call.callee == entry.effect ? named : others).push_back(call);
  std::vector<ListPlace> out;
  const auto look = [&](const std::vector<Call>& calls, bool variables) {
    for (std::size_t open = 0; open < text.size(); ++open) {
      if (!text.is(open, "{") || text.partner(open) == LuaText::kNone) continue;
      const auto items = text.items(open);
      for (const std::size_t index : list_items(text, open)) {
        const auto& item = items[index];
        const bool made_here = std::ranges::any_of(calls, [&](const Call& call) {
          if (!variables) return call.open >= item.value && call_end(text, call) == item.end;
          return item.end == item.value + 1 && text[item.value].kind == TokenKind::name &&
                 text[item.value].text == variable_of(text, call);
        });
        if (made_here && out.size() < kMostPlaces && !has(out, {open, index})) out.push_back({open, index});
      }
    }
  };
  look(named, false);
  look(named, true);
  look(others, false);
  return out;
}

std::vector<std::size_t> stack_tables(const LuaText& text) {
  std::vector<std::size_t> out;
  for (const Call& call : text.calls()) {
    if (call.callee != "stack" && call.callee != "extend") continue;
    std::size_t open = call.open;
    if (text.is(open, "(") && text.partner(open) != LuaText::kNone && text.is(text.partner(open) - 1, "}"))
      open = text.partner(text.partner(open) - 1);  // the last argument
    if (open != LuaText::kNone && text.is(open, "{") && text.partner(open) != LuaText::kNone) out.push_back(open);
  }
  std::ranges::reverse(out);
  return out;
}

std::string library_name(const LuaText& text) {
  for (std::size_t i = 0; i + 3 < text.size(); ++i) {
    if (text[i].kind != TokenKind::name || !text.is(i + 1, "=") || !text.is(i + 2, "require")) continue;
    const std::size_t name = text.is(i + 3, "(") ? i + 4 : i + 3;
    if (name < text.size() && text[name].inside() == "afterglow") return std::string(text[i].text);
  }
  return "fx";
}

}  // namespace afterglow::script
