// SPDX-License-Identifier: MIT
#include "shader/function_weights.h"

#include <utility>

#include "core/saturated.h"

namespace afterglow {
namespace {

/// Functions of GLSL.std.450 that are an instruction or two: rounding, abs, sign; min, max, clamp, mix; step; fma; min
/// and max beside NaN.
bool is_cheap(std::uint32_t function) {
  const auto within = [&](std::uint32_t first, std::uint32_t last) { return function >= first && function <= last; };
  return within(1, 10) || within(37, 46) || function == 48 || function == 50 || within(79, 81);
}

/// What an instruction comes to in registers: memory is none of it, since arrays are to become values.
std::uint64_t weight_of(const Instruction& i) {
  constexpr std::uint64_t kOfFunction = 32, kOfImage = 16, kOfBranch = 16;
  switch (i.op) {
    case spv::OpLoad:
    case spv::OpStore:
    case spv::OpAccessChain:
    case spv::OpLabel:
    case spv::OpBranch:
    case spv::OpLoopMerge:
    case spv::OpVariable:
    case spv::OpLine:
    case spv::OpNoLine:
      return 0;
    case spv::OpSelectionMerge:
      return kOfBranch;
    case spv::OpExtInst:
      return is_cheap(i.words[4]) ? 1 : kOfFunction;
    default:
      return i.op >= spv::OpSampledImage && i.op <= spv::OpImageQuerySamples ? kOfImage : 1;
  }
}

}  // namespace

FunctionWeights::FunctionWeights(const Module& module) {
  Function* function = nullptr;
  for (const auto& i : module.code) {
    if (i.op == spv::OpFunction) {
      order_.push_back(i.result);
      function = &functions_[i.result];
    }
    if (i.op == spv::OpEntryPoint) functions_[i.words[2]].times = 1;
    if (!function) continue;
    function->own += weight_of(i);
    function->loops |= i.op == spv::OpLoopMerge;
    if (i.op == spv::OpFunctionCall) function->calls.push_back(i.words[3]);
  }
  for (const auto id : order_) weight(id);
  count_calls();
}

std::uint64_t FunctionWeights::weight(const Instruction& i) {
  return i.op == spv::OpFunctionCall ? saturated_sum({1, weight(i.words[3])}) : weight_of(i);
}

/// GLSL has no recursion.
std::uint64_t FunctionWeights::weight(std::uint32_t id) {
  Function& function = functions_[id];
  if (std::exchange(function.weighed, true)) return function.whole;
  std::uint64_t whole = function.own;
  for (const auto called : function.calls) {
    whole = saturated_sum({whole, weight(called)});
    function.loops |= functions_[called].loops;
  }
  return function.whole = whole;
}

/// Callers first.
void FunctionWeights::count_calls() {
  std::vector<std::uint32_t> callees_first;
  for (const auto id : order_) visit(id, callees_first);
  for (auto id = callees_first.rbegin(); id != callees_first.rend(); ++id)
    for (const auto called : functions_[*id].calls)
      functions_[called].times = saturated_sum({functions_[called].times, functions_[*id].times});
}

void FunctionWeights::visit(std::uint32_t id, std::vector<std::uint32_t>& callees_first) {
  if (std::exchange(functions_[id].counted, true)) return;
  for (const auto called : functions_[id].calls) visit(called, callees_first);
  callees_first.push_back(id);
}

}  // namespace afterglow
