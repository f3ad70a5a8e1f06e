// SPDX-License-Identifier: MIT
#include "edit/table_edit.h"

#include <algorithm>

namespace afterglow::script {
namespace {

constexpr std::size_t kWidth = 110;  // columns: where tables of several lines are broken

using Item = LuaText::Item;

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t\r\n\f\v") == std::string_view::npos; }
bool has_break(std::string_view text) { return text.find_first_of("\r\n") != std::string_view::npos; }

/// Offsets and style of the items of one constructor.
class Layout {
 public:
  Layout(const LuaText& text, std::size_t begin)
      : lua(text), open(begin), close(text.partner(begin)), items(text.items(begin)) {}

  std::string_view between(std::size_t begin, std::size_t end) const { return lua.text().substr(begin, end - begin); }
  std::size_t begin(const Item& item) const { return lua[item.first].begin; }
  std::size_t value_end(const Item& item) const { return lua[item.end - 1].end(); }
  bool separated(const Item& item) const { return item.end != close; }
  /// Behind the separator.
  std::size_t end(const Item& item) const { return separated(item) ? lua[item.end].end() : value_end(item); }

  std::size_t line_begin(std::size_t offset) const {
    const std::size_t at = lua.text().find_last_of("\r\n", offset == 0 ? 0 : offset - 1);
    return offset == 0 || at == std::string_view::npos ? 0 : at + 1;
  }
  std::string_view before_on_line(std::size_t offset) const { return between(line_begin(offset), offset); }
  bool starts_line(std::size_t offset) const { return is_blank(before_on_line(offset)); }
  std::string indent(std::size_t offset) const {
    const auto line = before_on_line(offset);
    return std::string(line.substr(0, std::min(line.find_first_not_of(" \t"), line.size())));
  }
  /// As the text breaks its lines.
  std::string line_break() const {
    const std::size_t at = lua.text().find_first_of("\r\n");
    if (at == std::string_view::npos) return "\n";
    return lua.text().substr(at, 2) == "\r\n" ? "\r\n" : std::string(1, lua.text()[at]);
  }

  bool one_line() const { return lua[open].line == lua[close].line; }
  /// Has every item a line of its own (the first may stand behind the bracket)?
  bool line_each() const {
    if (one_line() || !starts_line(begin(items.back()))) return false;
    if (items.size() == 1) return lua[items.back().end - 1].line != lua[close].line;
    return std::all_of(items.begin() + 1, items.end(), [&](const Item& item) { return starts_line(begin(item)); });
  }

  const LuaText& lua;
  const std::size_t open, close;
  const std::vector<Item> items;
};

bool is_identifier_text(const std::string& key) {
  const LuaText text(key);
  return text.size() == 1 && text[0].kind == TokenKind::name && text[0].text == key;
}

// `key = value` as the nearest item with a name is written.
std::string item_text(const Layout& layout, const std::string& key, const std::string& value) {
  const LuaText& lua = layout.lua;
  bool bracket = !is_identifier_text(key);
  char quote = '"';
  std::string before = " ", after = " ";
  for (auto item = layout.items.rbegin(); item != layout.items.rend(); ++item) {
    if (item->value == item->first) continue;
    const std::size_t equals = item->value - 1;
    const auto gap = [&](std::size_t left) {
      return std::string(layout.between(lua[left].end(), lua[left + 1].begin));
    };
    const std::string left = gap(equals - 1), right = gap(equals);
    if (left.find_first_not_of(' ') == std::string::npos) before = left;
    if (right.empty() || right == " ") after = right;
    if (lua.is(item->first, "[") && lua[item->first + 1].kind == TokenKind::text) {
      bracket = true;
      if (lua[item->first + 1].text[0] == '\'') quote = '\'';
    }
    // Columns: the sign stands below the others.
    const std::size_t width = lua[equals - 1].end() - layout.begin(*item) + before.size();
    const std::size_t own = key.size() + (bracket ? 4 : 0);
    if (before.size() > 1) before.assign(width > own ? width - own : 1, ' ');
    break;
  }
  const std::string name = bracket ? std::string("[") + quote + key + quote + "]" : key;
  return name + before + "=" + after + value;
}

Replacements into_empty(const Layout& layout, const std::string& item) {
  const LuaText& lua = layout.lua;
  const std::size_t begin = lua[layout.open].end(), end = lua[layout.close].begin;
  const auto inside = layout.between(begin, end);
  if (!is_blank(inside)) {  // comments
    if (layout.one_line()) return {{end, 0, inside.back() == ' ' ? item + " " : " " + item + " "}};
    const std::string indent = layout.starts_line(end) ? layout.indent(end) : layout.indent(begin);
    return {{lua.end_of_line(begin), 0, layout.line_break() + indent + "  " + item + ","}};
  }
  if (!has_break(inside)) return {{begin, inside.size(), " " + item + " "}};
  return {{lua.end_of_line(begin), 0, layout.line_break() + layout.indent(end) + "  " + item + ","}};
}

// On the line of the last item, or on the next when that one is full.
Replacements behind_last(const Layout& layout, const Item& last, const std::string& item) {
  const bool trailing = layout.separated(last);
  const std::size_t at = layout.end(last);
  const char separator = trailing                  ? layout.lua[last.end].text[0]
                         : layout.items.size() > 1 ? layout.lua[layout.items[layout.items.size() - 2].end].text[0]
                                                   : ',';
  std::string space = " ";
  if (layout.items.size() > 1) {
    const Item& previous = layout.items[layout.items.size() - 2];
    const auto gap = layout.between(layout.end(previous), layout.begin(last));
    if (gap.empty()) space = "";
  }
  if (!layout.one_line() && layout.before_on_line(at).size() + item.size() > kWidth) {
    for (const Item& other : layout.items) {
      const auto line = layout.before_on_line(layout.begin(other));
      if (&other != &layout.items.front() && is_blank(line)) space = layout.line_break() + std::string(line);
    }
  }
  std::string text = trailing ? space + item + separator : separator + space + item;
  return {{at, 0, std::move(text)}};
}

Replacements on_own_line(const Layout& layout, const Item& last, const std::string& item) {
  const LuaText& lua = layout.lua;
  const bool trailing = layout.separated(last);
  const std::size_t stop = layout.end(last);
  const char separator = trailing                  ? lua[last.end].text[0]
                         : layout.items.size() > 1 ? lua[layout.items[layout.items.size() - 2].end].text[0]
                                                   : ',';
  std::string line = layout.line_break() + layout.indent(layout.begin(last)) + item;
  if (trailing) line += separator;
  // Behind a comment on the last item's line, unless more of the script stands there.
  const int last_line = lua[trailing ? last.end : last.end - 1].line;
  std::size_t at = lua[layout.close].line > last_line ? lua.end_of_line(stop) : stop;
  if (at > lua[layout.close].begin) at = stop;
  if (trailing) return {{at, 0, std::move(line)}};
  if (at == stop) return {{stop, 0, separator + line}};
  return {{stop, 0, std::string(1, separator)}, {at, 0, std::move(line)}};
}

/// An item with what goes where it goes: pieces of the text, in their order.
struct Slot {
  struct Piece {
    std::size_t begin = 0, end = 0;
  };
  Piece above, value, behind;
};

// Where the line of the item ends, when nothing but comments stands behind it there.
std::optional<std::size_t> own_line_end(const Layout& layout, const Item& item) {
  const LuaText& lua = layout.lua;
  if (!layout.starts_line(layout.begin(item))) return {};
  const std::size_t stop = layout.end(item), end = lua.end_of_line(stop);
  const std::size_t next = layout.separated(item) ? item.end + 1 : item.end;
  if (next < lua.size() && lua[next].begin < end) return {};
  return end;
}

// Where the lines of comments right above the item begin; its own line where there are none.
std::size_t comments_begin(const Layout& layout, const Item& item, std::size_t least) {
  std::size_t begin = layout.line_begin(layout.begin(item));
  while (begin > least && begin >= 2) {
    const std::size_t above = layout.line_begin(begin - (layout.between(begin - 2, begin) == "\r\n" ? 2 : 1));
    const auto line = layout.between(above, begin);
    const std::size_t first = line.find_first_not_of(" \t");
    // A comment of one line: one that goes over several, which may end in "--]]", may not be cut.
    const bool of_several = line.find("]]") != std::string_view::npos || line.find("]=") != std::string_view::npos;
    if (above < least || first == std::string_view::npos || of_several || !line.substr(first).starts_with("--") ||
        line.substr(first).starts_with("--["))
      break;
    begin = above;
  }
  return begin;
}

Slot slot_of(const Layout& layout, const Item& item) {
  const std::size_t begin = layout.begin(item), value_end = layout.value_end(item), end = layout.end(item);
  Slot slot{{begin, begin}, {begin, value_end}, {end, end}};
  const auto line_end = own_line_end(layout, item);
  if (!line_end) return slot;
  slot.behind = {end, *line_end};
  const std::size_t before = item.first == 0 ? 0 : layout.lua[item.first - 1].end();
  const std::size_t line = layout.line_begin(begin);
  slot.above = {comments_begin(layout, item, layout.lua.end_of_line(before)), line};
  return slot;
}

// The piece in another place: what stands before its first line there stays.
void put(Replacements& out, const Layout& layout, const Slot::Piece& place, const Slot::Piece& piece) {
  const auto text = layout.between(piece.begin, piece.end);
  if (text != layout.between(place.begin, place.end))
    out.push_back({place.begin, place.end - place.begin, std::string(text)});
}

}  // namespace

std::string replaced(std::string_view text, const Replacements& replacements) {
  std::string out;
  std::size_t at = 0;
  for (const auto& part : replacements) {
    out += text.substr(at, part.offset - at);
    out += part.text;
    at = part.offset + part.length;
  }
  return out + std::string(text.substr(at));
}

std::optional<Item> find_item(const LuaText& text, std::size_t open, std::string_view key) {
  std::optional<Item> found;
  for (auto& item : text.items(open))
    if (item.key == key) found = std::move(item);
  return found;
}

Replacements insert_item(const LuaText& text, std::size_t open, const std::string& key, const std::string& value) {
  const Layout layout(text, open);
  const std::string item = item_text(layout, key, value);
  if (layout.items.empty()) return into_empty(layout, item);
  const Item& last = layout.items.back();
  return layout.line_each() ? on_own_line(layout, last, item) : behind_last(layout, last, item);
}

std::optional<Replacements> remove_item(const LuaText& text, std::size_t open, const Item& wanted) {
  const Layout layout(text, open);
  const auto item = std::find_if(layout.items.begin(), layout.items.end(),
                                 [&](const Item& other) { return other.first == wanted.first; });
  if (item == layout.items.end()) return {};
  const bool is_first = item == layout.items.begin(), is_last = item + 1 == layout.items.end();
  const std::size_t begin = layout.begin(*item), end = layout.end(*item);
  const std::size_t before = is_first ? text[open].end() : layout.end(*(item - 1));
  const std::size_t after = is_last ? text[layout.close].begin : layout.begin(*(item + 1));
  const auto left = layout.between(before, begin), right = layout.between(end, after);
  // Between tokens of the item there may be comments too; a value's own tokens are looked at one by one.
  for (std::size_t i = item->first; i + 1 < text.size() && text[i + 1].end() <= end; ++i)
    if (!is_blank(layout.between(text[i].end(), text[i + 1].begin))) return {};
  if (!is_blank(left) || !is_blank(right)) return {};

  // The separator before the last item goes with it where the last has none.
  const bool drop_previous = is_last && !is_first && !layout.separated(*item);
  const std::size_t previous = drop_previous ? layout.value_end(*(item - 1)) : before;
  if (drop_previous && !is_blank(layout.between(previous, text[(item - 1)->end].begin))) return {};
  if (layout.starts_line(begin) && has_break(right)) {
    const std::size_t line = layout.line_begin(begin);
    std::size_t next = text.end_of_line(end);
    next += text.text().substr(next, 2) == "\r\n" ? 2 : 1;
    Replacements out;
    if (drop_previous) out.push_back({previous, before - previous, ""});
    out.push_back({line, next - line, ""});
    return out;
  }
  if (drop_previous) return Replacements{{previous, end - previous, ""}};
  if (is_last) return Replacements{{before, (is_first && !has_break(right) ? after : end) - before, ""}};
  if (has_break(right) && !is_first) return Replacements{{before, end - before, ""}};
  return Replacements{{begin, after - begin, ""}};
}

Replacements insert_behind(const LuaText& text, std::size_t open, std::size_t behind, const std::string& source) {
  const Layout layout(text, open);
  const Item& item = layout.items[behind];
  return layout.line_each() ? on_own_line(layout, item, source) : behind_last(layout, item, source);
}

Replacements insert_first(const LuaText& text, std::size_t open, const std::string& source) {
  return into_empty(Layout(text, open), source);
}

Replacements take_out(const LuaText& text, std::size_t open, std::size_t index) {
  const Layout layout(text, open);
  const Item& item = layout.items[index];
  const bool is_last = index + 1 == layout.items.size();
  Replacements out;
  // Where the last item has no separator, the one before it has none either.
  if (is_last && index > 0 && !layout.separated(item)) {
    const Token& separator = text[layout.items[index - 1].end];
    out.push_back({separator.begin, separator.text.size(), ""});
  }
  if (const auto line_end = own_line_end(layout, item)) {
    const std::size_t line = layout.line_begin(layout.begin(item));
    const std::size_t next = *line_end + (text.text().substr(*line_end, 2) == "\r\n" ? 2 : 1);
    out.push_back({line, std::min(next, text.text().size()) - line, ""});
    return out;
  }
  const std::size_t before = text[item.first - 1].end(), begin = layout.begin(item), end = layout.end(item);
  const std::size_t after = text[layout.separated(item) ? item.end + 1 : item.end].begin;
  const auto left = layout.between(before, begin), right = layout.between(end, after);
  const bool clear_left = is_blank(left) && !has_break(left), clear_right = is_blank(right) && !has_break(right);
  const bool alone = layout.items.size() == 1;
  const std::size_t from = clear_left && (alone || is_last || !clear_right) ? before : begin;
  const bool blank_before = text.text()[begin - 1] == ' ';
  const bool takes_right = alone ? from == before : !is_last || (from == begin && blank_before);
  const std::size_t to = clear_right && takes_right ? after : end;
  // Not both the spaces before and behind, where something stands on either side.
  out.push_back({from, (from == before && !alone ? end : to) - from, ""});
  return out;
}

Replacements move_item(const LuaText& text, std::size_t open, const std::vector<std::size_t>& among, std::size_t from,
                       std::size_t to) {
  const Layout layout(text, open);
  std::vector<std::size_t> places;
  for (const std::size_t index : among)
    if (index >= std::min(from, to) && index <= std::max(from, to)) places.push_back(index);
  std::vector<std::size_t> order = places;  // which item comes into which place
  if (from < to)
    std::rotate(order.begin(), order.begin() + 1, order.end());
  else
    std::rotate(order.begin(), order.end() - 1, order.end());
  std::vector<Slot> slots;
  for (const std::size_t index : places) slots.push_back(slot_of(layout, layout.items[index]));
  // Comments of lines go along between lines alone: elsewhere they would hide what follows.
  const bool lines = std::ranges::all_of(
      places, [&](std::size_t index) { return own_line_end(layout, layout.items[index]).has_value(); });
  Replacements out;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto moved = static_cast<std::size_t>(std::ranges::find(places, order[i]) - places.begin());
    if (lines) put(out, layout, slots[i].above, slots[moved].above);
    put(out, layout, slots[i].value, slots[moved].value);
    if (lines) put(out, layout, slots[i].behind, slots[moved].behind);
  }
  return out;
}

}  // namespace afterglow::script
