// SPDX-License-Identifier: MIT
// Which loops of a module need a guard (guard_loops.h), and what their turns count. Internal to the room.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include "shader/guard_loops.h"
#include "shader/spirv_loops.h"

namespace afterglow {

/// Both arguments must outlive it.
class LoopWeights {
 public:
  LoopWeights(const Module& module, const std::vector<Loop>& loops);
  bool guarded(std::size_t loop) const { return guarded_[loop]; }
  bool any() const;
  /// How many turns a turn of it stands for: those of the loops of constants within.
  std::uint32_t weight(std::size_t loop) const;
  /// Invocations of a workgroup wait for each other in it.
  bool waits(std::size_t loop) const { return waits_[loop]; }
  /// A call of the function may come to a guarded loop.
  bool guards(std::uint32_t function) const { return guarding_.contains(function); }

 private:
  std::uint64_t turns_of_function(std::uint32_t id);
  std::uint64_t turns_within(int around, std::size_t function);
  std::uint64_t turns_of(std::size_t loop);
  int innermost(std::uint32_t label, std::size_t function) const;
  std::set<std::uint32_t> functions_with(const std::function<bool(std::size_t)>& has) const;
  void find_waits();

  const std::vector<Instruction>& code_;
  const std::vector<Loop>& loops_;
  std::map<std::uint32_t, std::size_t> functions_;
  std::map<std::uint32_t, std::uint64_t> turns_;  ///< of functions, without those of guarded loops
  std::set<std::uint32_t> guarding_;              ///< functions with guarded loops, by themselves or in what they call
  std::vector<bool> guarded_, waits_;
  std::vector<std::uint64_t> weights_;
};

}  // namespace afterglow
