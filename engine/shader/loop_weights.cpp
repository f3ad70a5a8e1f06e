// SPDX-License-Identifier: MIT
#include "shader/loop_weights.h"

#include <algorithm>

#include "core/saturated.h"

namespace afterglow {

LoopWeights::LoopWeights(const Module& module, const std::vector<Loop>& loops) : code_(module.code), loops_(loops) {
  for (std::size_t at = 0; at < code_.size(); ++at)
    if (code_[at].op == spv::OpFunction) functions_[code_[at].result] = at;
  guarded_.resize(loops.size());
  waits_.resize(loops.size());
  weights_.assign(loops.size(), 1);
  for (const auto& [id, at] : functions_) (void)turns_of_function(id);
  find_waits();
  std::set<std::size_t> heads;
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (guarded_[i]) heads.insert(loops[i].head);
  guarding_ = functions_with([&](std::size_t at) { return heads.contains(at); });
}

bool LoopWeights::any() const { return std::ranges::find(guarded_, true) != guarded_.end(); }

std::uint32_t LoopWeights::weight(std::size_t loop) const {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(weights_[loop], kMaxTurns));
}

std::uint64_t LoopWeights::turns_of_function(std::uint32_t id) {
  if (const auto known = turns_.find(id); known != turns_.end()) return known->second;
  turns_[id] = 0;  // there is no recursion in GLSL; elsewhere it ends here
  return turns_[id] = turns_within(-1, functions_.at(id));
}

/// Turns of the unguarded loops directly in a loop (−1: a function), and in what is called there.
std::uint64_t LoopWeights::turns_within(int around, std::size_t function) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < loops_.size(); ++i)
    if (loops_[i].parent == around && loops_[i].function == function) sum = saturated_sum({sum, turns_of(i)});
  std::uint32_t label = 0;
  for (std::size_t at = function; code_[at].op != spv::OpFunctionEnd; ++at) {
    if (code_[at].op == spv::OpLabel) label = code_[at].result;
    if (code_[at].op == spv::OpFunctionCall && innermost(label, function) == around)
      sum = saturated_sum({sum, turns_of_function(code_[at].words[3])});
  }
  return sum;
}

int LoopWeights::innermost(std::uint32_t label, std::size_t function) const {
  int found = -1;
  for (std::size_t i = 0; i < loops_.size(); ++i)
    if (loops_[i].function == function && loops_[i].blocks.contains(label) &&
        (found < 0 || loops_[i].blocks.size() < loops_[static_cast<std::size_t>(found)].blocks.size()))
      found = static_cast<int>(i);
  return found;
}

std::uint64_t LoopWeights::turns_of(std::size_t loop) {
  weights_[loop] = saturated_sum({1, turns_within(static_cast<int>(loop), loops_[loop].function)});
  const auto most = loops_[loop].most_turns;
  const std::uint64_t turns = most ? saturated_product({*most, weights_[loop]}) : kSaturated;
  guarded_[loop] = turns > kFewTurns;
  return guarded_[loop] ? 0 : turns;
}

/// Functions in which an instruction (by its place) is of a kind, and those that call them, until there are no more.
std::set<std::uint32_t> LoopWeights::functions_with(const std::function<bool(std::size_t)>& has) const {
  std::set<std::uint32_t> found;
  std::size_t before = 0;
  do {
    before = found.size();
    std::uint32_t function = 0;
    for (std::size_t at = 0; at < code_.size(); ++at) {
      const Instruction& i = code_[at];
      if (i.op == spv::OpFunction) function = i.result;
      if ((i.op == spv::OpFunctionCall && found.contains(i.words[3])) || has(at)) found.insert(function);
    }
  } while (found.size() > before);
  return found;
}

/// Functions that wait, then the loops around such places.
void LoopWeights::find_waits() {
  const auto waiting = functions_with([&](std::size_t at) { return code_[at].op == spv::OpControlBarrier; });
  const auto waits_at = [&](const Instruction& i) {
    return i.op == spv::OpControlBarrier || (i.op == spv::OpFunctionCall && waiting.contains(i.words[3]));
  };
  std::uint32_t label = 0;
  for (const Instruction& i : code_) {
    if (i.op == spv::OpLabel) label = i.result;
    if (!waits_at(i)) continue;
    for (std::size_t loop = 0; loop < loops_.size(); ++loop)
      if (loops_[loop].blocks.contains(label)) waits_[loop] = true;
  }
}

}  // namespace afterglow
