// SPDX-License-Identifier: MIT
#include "shader/check.h"

namespace afterglow {

Result<void> check_shader(KernelCompiler& compiler, std::shared_ptr<const ShaderSource> shader,
                          const std::map<std::string, double>& constants) {
  KernelDesc kernel;
  KernelStage stage{std::move(shader), constants, {}};
  if (info_of(stage.shader->interface.kind).begins) {
    kernel.sample = std::move(stage);
  } else {
    kernel.stages.push_back(std::move(stage));
  }
  AFTERGLOW_TRY(const CompiledKernel compiled, compiler.compile(kernel));
  static_cast<void>(compiled);
  return {};
}

}  // namespace afterglow
