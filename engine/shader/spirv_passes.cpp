// SPDX-License-Identifier: MIT
#include "shader/spirv_passes.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "core/saturated.h"
#include "shader/spirv_loops.h"

namespace afterglow {
namespace {

struct Calls {
  std::vector<std::uint32_t> of;  ///< functions, once for each call
  bool stays = false;             ///< is called, never inlined
  std::uint64_t inlined = 0;      ///< with those of the functions that it calls
  bool counted = false;
};

/// GLSL has no recursion.
std::uint64_t inlined_calls(std::map<std::uint32_t, Calls>& functions, std::uint32_t id) {
  Calls& calls = functions[id];
  if (calls.counted) return calls.inlined;
  calls.counted = true;
  for (const auto called : calls.of) {
    const std::uint64_t inner = inlined_calls(functions, called);
    if (!functions[called].stays) calls.inlined = saturated_sum({calls.inlined, inner, 1});
  }
  return calls.inlined;
}

/// Instructions of each block, by label. A function of GLSL (sin, pow) is many to the device's compiler.
std::map<std::uint32_t, std::uint64_t> block_sizes(const Module& module) {
  constexpr std::uint64_t kOfFunction = 32;
  std::map<std::uint32_t, std::uint64_t> out;
  std::uint64_t* size = nullptr;
  for (const auto& i : module.code) {
    if (i.op == spv::OpLabel) size = &out[i.result];
    if (i.op == spv::OpFunctionEnd) size = nullptr;
    if (size) *size += i.op == spv::OpExtInst ? kOfFunction : 1;
  }
  return out;
}

/// Loops of so many turns become straight code, as long as that adds no more than so many instructions: only the rows
/// of straight code take turns and share what they read.
constexpr std::uint64_t kMostTurns = 16, kMostMore = 1024;

/// Asks for the loops that are to become straight code. False: there is none.
bool mark_short_loops(Module& module) {
  const std::vector<Loop> loops = find_loops(module);
  const std::map<std::uint32_t, std::uint64_t> sizes = block_sizes(module);
  std::vector<std::size_t> inner_first(loops.size());
  std::iota(inner_first.begin(), inner_first.end(), std::size_t{0});
  std::ranges::stable_sort(inner_first, {}, [&](std::size_t i) { return loops[i].blocks.size(); });
  std::vector<std::uint64_t> added(loops.size());  // to each, by loops within it
  std::vector<bool> stays(loops.size());           // for the sake of one within it
  std::uint64_t more = 0;
  bool any = false;
  for (const std::size_t i : inner_first) {
    const Loop& loop = loops[i];
    std::uint64_t size = added[i];
    for (const auto label : loop.blocks) size += sizes.at(label);
    const std::uint64_t turns = loop.counting ? loop.counting->turns.value_or(0) : 0;
    const bool is_short = turns > 0 && turns <= kMostTurns && !stays[i] && more + (turns - 1) * size <= kMostMore;
    if (is_short) {
      module.code[loop.head].words[3] |= spv::LoopControlUnrollMask;
      more += (turns - 1) * size;
      any = true;
    }
    if (loop.parent < 0) continue;
    const auto parent = static_cast<std::size_t>(loop.parent);
    if (is_short)
      added[parent] += (turns - 1) * size + added[i];
    else
      stays[parent] = true;
  }
  return any;
}

}  // namespace

void be_quiet(spvtools::Optimizer& optimizer) {
  optimizer.SetMessageConsumer([](spv_message_level_t, const char*, const spv_position_t&, const char*) {});
}

std::uint32_t function_named(const Module& module, std::string_view name) {
  for (const auto& instruction : module.code) {
    if (instruction.op != spv::OpName) continue;
    const std::string_view text = reinterpret_cast<const char*>(&instruction.words[2]);
    if (text.substr(0, text.find('(')) == name) return instruction.words[1];
  }
  return 0;
}

void forbid_inlining(Module& module, std::uint32_t function) {
  for (auto& instruction : module.code)
    if (instruction.op == spv::OpFunction && instruction.result == function)
      instruction.words[3] = spv::FunctionControlDontInlineMask;
}

bool is_pure_function(const Instruction& function) {
  constexpr std::uint32_t kModf = 35, kFrexp = 51, kFirstInterpolation = 76, kLastInterpolation = 78;
  const std::uint32_t number = function.words[4];
  return number != kModf && number != kFrexp && (number < kFirstInterpolation || number > kLastInterpolation);
}

bool inlines_quickly(const Module& module) {
  std::map<std::uint32_t, Calls> functions;
  Calls* function = nullptr;
  for (const auto& i : module.code) {
    if (i.op == spv::OpFunction) {
      function = &functions[i.result];
      function->stays = (i.words[3] & spv::FunctionControlDontInlineMask) != 0;
    }
    if (i.op == spv::OpFunctionCall && function) function->of.push_back(i.words[3]);
  }
  return std::ranges::all_of(
      functions, [&](const auto& named) { return inlined_calls(functions, named.first) <= kMaxInlinedCalls; });
}

bool rewrites_quickly(const Module& module) {
  std::uint64_t variables = 0, blocks = 0;
  for (const auto& i : module.code) {
    if (i.op == spv::OpFunction) variables = blocks = 0;
    variables += i.op == spv::OpVariable && i.words[3] == spv::StorageClassFunction;
    blocks += i.op == spv::OpLabel;
    if (i.op == spv::OpFunctionEnd && variables * blocks > kMaxVariablesTimesBlocks) return false;
  }
  return true;
}

void add_inlining_passes(spvtools::Optimizer& optimizer) {
  be_quiet(optimizer);
  optimizer.RegisterPass(spvtools::CreateInlineExhaustivePass())
      .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
      .RegisterPass(spvtools::CreatePrivateToLocalPass())
      .RegisterPass(spvtools::CreateScalarReplacementPass())
      .RegisterPass(spvtools::CreateLocalAccessChainConvertPass())
      .RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass())
      .RegisterPass(spvtools::CreateLocalSingleStoreElimPass());
}

void add_rewriting_passes(spvtools::Optimizer& optimizer, Module& inlined) {
  be_quiet(optimizer);
  optimizer.RegisterPass(spvtools::CreateSSARewritePass());
  if (mark_short_loops(inlined)) optimizer.RegisterPass(spvtools::CreateLoopUnrollPass(true));
}

std::optional<Module> run_passes(const spvtools::Optimizer& optimizer, const Module& module) {
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);
  const Words before = module.join();
  Words after;
  if (!optimizer.Run(before.data(), before.size(), &after, options)) return std::nullopt;
  return parse(after);
}

Result<Words> with_held_indices(const Words& spirv) {
  spvtools::Optimizer optimizer(kSpirvEnvironment);
  std::string fault;
  optimizer.SetMessageConsumer(
      [&](spv_message_level_t, const char*, const spv_position_t&, const char* text) { fault = text; });
  optimizer.RegisterPass(spvtools::CreateGraphicsRobustAccessPass());
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);
  Words out;
  if (!optimizer.Run(spirv.data(), spirv.size(), &out, options))
    return Error{ErrorKind::other, "indices cannot be held within their arrays: " + fault};
  // What is held looks less like a step through an array to drivers, which then leave loops that they unrolled.
  if (out == spirv) return out;
  auto module = parse(out);
  if (module && mark_short_loops(*module)) out = module->join();
  return out;
}

std::optional<Module> without_variables(const Module& module) {
  if (!inlines_quickly(module)) return std::nullopt;
  spvtools::Optimizer inlining(kSpirvEnvironment);
  add_inlining_passes(inlining);
  inlining.RegisterPass(spvtools::CreateAggressiveDCEPass());
  auto inlined = run_passes(inlining, module);
  if (!inlined || !rewrites_quickly(*inlined)) return std::nullopt;
  spvtools::Optimizer optimizer(kSpirvEnvironment);
  add_rewriting_passes(optimizer, *inlined);
  // Constants are not folded here: exp2(-1) of this machine may be other bits than the device's.
  optimizer.RegisterPass(spvtools::CreateDeadBranchElimPass())
      .RegisterPass(spvtools::CreateBlockMergePass())
      .RegisterPass(spvtools::CreateAggressiveDCEPass());
  return run_passes(optimizer, *inlined);
}

}  // namespace afterglow
