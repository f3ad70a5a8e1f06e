// SPDX-License-Identifier: MIT
#include "shader/loop_places.h"

#include "shader/lined_module.h"

namespace afterglow {

Result<std::vector<std::uint32_t>> loop_places(const std::string& glsl, GlslStage stage) {
  AFTERGLOW_TRY(const LinedModule lined, compile_with_lines(glsl, stage));
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i < lined.module.code.size(); ++i)
    if (lined.module.code[i].op == spv::OpLoopMerge)
      out.insert(out.end(), {lined.places[i].file, lined.places[i].line});
  return out;
}

}  // namespace afterglow
