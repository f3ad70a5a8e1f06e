// SPDX-License-Identifier: MIT
#include "shader/spirv_passes.h"

namespace afterglow {

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

}  // namespace afterglow
