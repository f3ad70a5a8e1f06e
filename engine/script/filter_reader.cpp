// SPDX-License-Identifier: MIT
#include "script/filter_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "core/text.h"

namespace afterglow::script {
namespace {

constexpr std::size_t kMaxTaps = 256;
constexpr double kMaxOffset = 16384;  // texels

// The taps of one key, each with `parts` numbers: offsets, then the weight.
std::vector<std::array<double, 4>> read_taps(lua_State* lua, const TableReader& filter, const char* name, int parts,
                                             TableReader& call) {
  std::vector<std::array<double, 4>> taps;
  const char* shape = parts == 2 ? "{{offset, weight}, …}" : "{{dx, dy, weight}, …}";
  const auto wrong = [&](const std::string& message) { call.fail(failure(message, {"filter", name}, shape)); };
  filter.push(name);
  if (!lua_istable(lua, -1)) {
    wrong(fmt::format("{}: {} = {} is not a list of taps", filter.what(), name, read_value(lua, -1).shown()));
  } else {
    const auto size = lua_rawlen(lua, -1);
    if (size == 0 || size > kMaxTaps)
      wrong(fmt::format("{}: {} has {} taps, not 1…{}", filter.what(), name, size, kMaxTaps));
    for (std::size_t i = 1; i <= size && size <= kMaxTaps; ++i) {
      lua_rawgeti(lua, -1, static_cast<lua_Integer>(i));
      const Value tap = read_value(lua, -1);
      lua_pop(lua, 1);
      const bool fits = tap.kind == Value::Kind::list && tap.count == parts;
      const auto numbers = std::span(tap.list).first(fits ? static_cast<std::size_t>(parts) : 0);
      const auto finite = [](double v) { return std::isfinite(static_cast<float>(v)); };
      const auto far = [](double v) { return std::abs(v) > kMaxOffset; };
      if (!fits || !std::ranges::all_of(numbers, finite)) {
        wrong(fmt::format("{}: tap {} of {} is {}", filter.what(), i, name, tap.shown()));
        break;
      }
      if (std::ranges::any_of(numbers.first(numbers.size() - 1), far)) {
        call.fail(failure(fmt::format("{}: tap {} of {} is {}, too far away", filter.what(), i, name, tap.shown()),
                          {"filter", name}, fmt::format("offsets of -{0} to {0} texels", kMaxOffset)));
        break;
      }
      taps.push_back(tap.list);
    }
  }
  lua_pop(lua, 1);
  return taps;
}

/// One of these names, in the order of the enumeration.
template <typename Choice>
Choice read_choice(const char* key, Choice usual, const std::vector<std::string>& names, TableReader& filter,
                   TableReader& call) {
  const Value given = filter.value(key);
  if (given.kind == Value::Kind::nothing) return usual;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (given.kind == Value::Kind::text && given.text == names[i]) return static_cast<Choice>(i);
  call.fail(failure(fmt::format("{}: unknown {} {}", filter.what(), key, given.shown()), {"filter", key}, join(names),
                    nearest_name(given.text, names)));
  return usual;
}

}  // namespace

Filter read_filter(lua_State* lua, TableReader& call) {
  Filter result;
  if (!lua_istable(lua, -1)) {
    call.fail(failure(fmt::format("{}: filter = {} is not a filter", call.what(), read_value(lua, -1).shown()),
                      {"filter"}, "{ interpolation, x, y, taps, edges }, fx.filters.…"));
    return result;
  }
  TableReader filter(lua, -1, call.what() + ": the filter");
  const std::vector<std::string> known{"edges", "interpolation", "taps", "x", "y"};
  for (const auto& key : filter.keys())
    if (std::find(known.begin(), known.end(), key.name) == known.end())
      call.fail(failure(fmt::format("{} has no '{}'", filter.what(), tidy_message(key.name, 60)), {"filter", key.name},
                        join(known), nearest_name(key.name, known)));
  result.interpolation =
      read_choice("interpolation", Interpolation::linear, {"nearest", "linear", "cubic_bspline"}, filter, call);
  result.edges = read_choice("edges", Edges::stretch, {"stretch", "mirror"}, filter, call);
  const auto has = [&](const char* name) { return filter.value(name).kind != Value::Kind::nothing; };
  if (has("taps") && (has("x") || has("y")))
    call.fail(
        failure(fmt::format("{} has taps and x or y; only one way at a time", filter.what()), {"filter", "taps"}));
  for (const char axis : {'x', 'y'}) {
    const char name[] = {axis, '\0'};
    if (!has(name)) continue;
    auto& taps = axis == 'x' ? result.x : result.y;
    taps.clear();
    for (const auto& tap : read_taps(lua, filter, name, 2, call)) taps.push_back({tap[0], tap[1]});
  }
  if (has("taps"))
    for (const auto& tap : read_taps(lua, filter, "taps", 3, call)) result.taps.push_back({tap[0], tap[1], tap[2]});
  return result;
}

}  // namespace afterglow::script
