// SPDX-License-Identifier: MIT
// A stack as one sees it when it runs, to tell whether another is the same but for a wanted change. Plain data.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "script/preset.h"

namespace afterglow::script {

/// One entry, without its name and its place in the text.
struct EntryShape {
  std::string name;   ///< of its preset
  std::string said;   ///< effect, switches, settings with what says them: equal for entries that do the same
  std::string mask;   ///< its text, with its settings
  std::string place;  ///< injection point and order; empty for groups, which stand where their members do
  int members = 0, depth = 0;
};
using StackShape = std::vector<EntryShape>;  ///< in the order of execution

StackShape shape_of(const Preset& preset);

/// The entry behind the unit (an entry with its members) that begins at `i`.
std::size_t unit_end(const StackShape& shape, std::size_t i);
/// The unit before or behind that of `i` in the same group, or half of a mix; none: it is the first or last.
std::optional<std::size_t> neighbour_of(const Preset& preset, std::size_t i, bool later);

/// Does `after` say what `before` does? `any_place`: an entry whose place may be another (kNobody: none).
inline constexpr std::size_t kNobody = static_cast<std::size_t>(-1);
bool same_stack(const StackShape& before, const StackShape& after, std::size_t any_place = kNobody);

/// Names in both, entry by entry; entries of `before` without a name are new.
std::vector<std::pair<std::string, std::string>> renamed(const StackShape& before, const StackShape& after);

}  // namespace afterglow::script
