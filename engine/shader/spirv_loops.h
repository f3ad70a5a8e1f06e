// SPDX-License-Identifier: MIT
// The loops of a module: what belongs to each, and how often those that count in whole numbers turn. Internal to the
// room.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "shader/spirv_module.h"

namespace afterglow {

/// A loop that counts a variable by a constant step to a bound that does not change meanwhile, and is left by its test
/// alone: `for (int i = a; i < n; i += s)`. Places are indices into Module::code.
struct Counting {
  std::size_t entry = 0;                ///< the branch into the loop, from outside
  std::size_t test = 0;                 ///< the branch that leaves it
  std::uint32_t variable = 0;           ///< pointer to what counts
  std::uint32_t type = 0;               ///< of it: a 32-bit number with a sign
  std::uint32_t bound = 0;              ///< id of the bound
  std::vector<std::size_t> bound_code;  ///< what computes the bound, behind the head: the same before the loop
  std::int32_t step = 0;                ///< not 0; its sign is that of the way to the bound
  bool inclusive = false;               ///< <= or >=
  std::optional<std::uint64_t> turns;   ///< when all of it is constant
};

struct Loop {
  std::uint32_t ordinal = 0;            ///< among all OpLoopMerge of the module
  std::size_t function = 0;             ///< of OpFunction
  std::uint32_t header = 0, merge = 0;  ///< labels
  std::size_t head = 0;                 ///< of OpLoopMerge; the branch is the next instruction
  std::set<std::uint32_t> blocks;       ///< labels, the header's included
  int parent = -1;                      ///< index of the loop around it
  std::optional<Counting> counting;
  std::optional<std::uint64_t> most_turns;  ///< when constants say so, however else it may be left
};

/// In the order of the module.
std::vector<Loop> find_loops(const Module& module);

/// Labels that a branch may go to; empty for other instructions.
std::vector<std::uint32_t> targets_of(const Instruction& branch);

}  // namespace afterglow
