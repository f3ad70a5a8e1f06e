// SPDX-License-Identifier: MIT
#include "shader/spirv_passes.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "core/saturated.h"

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

}  // namespace

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

void add_inlining_passes(spvtools::Optimizer& optimizer) {
  optimizer.SetMessageConsumer([](spv_message_level_t, const char*, const spv_position_t&, const char*) {});
  optimizer.RegisterPass(spvtools::CreateInlineExhaustivePass())
      .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
      .RegisterPass(spvtools::CreatePrivateToLocalPass())
      .RegisterPass(spvtools::CreateScalarReplacementPass())
      .RegisterPass(spvtools::CreateLocalAccessChainConvertPass())
      .RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass())
      .RegisterPass(spvtools::CreateLocalSingleStoreElimPass());
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
  return out;
}

std::optional<Module> without_variables(const Module& module) {
  if (!inlines_quickly(module)) return std::nullopt;
  spvtools::Optimizer optimizer(kSpirvEnvironment);
  add_inlining_passes(optimizer);
  optimizer.RegisterPass(spvtools::CreateAggressiveDCEPass())
      .RegisterPass(spvtools::CreateSSARewritePass())
      .RegisterPass(spvtools::CreateDeadBranchElimPass())
      .RegisterPass(spvtools::CreateBlockMergePass())
      .RegisterPass(spvtools::CreateAggressiveDCEPass());
  return run_passes(optimizer, module);
}

}  // namespace afterglow
