// SPDX-License-Identifier: MIT
#include "shader/loop_places.h"

#include "shader/lined_module.h"

namespace afterglow {

Result<std::vector<std::uint32_t>> loop_places(const std::string& glsl, GlslStage stage,
                                               const std::vector<std::uint32_t>& loops) {
  AFTERGLOW_TRY(const LinedModule lined, compile_with_lines(glsl, stage));
  std::vector<SourcePlace> all;
  for (std::size_t i = 0; i < lined.module.code.size(); ++i)
    if (lined.module.code[i].op == spv::OpLoopMerge) all.push_back(lined.places[i]);
  std::vector<std::uint32_t> out;
  for (const auto loop : loops) out.insert(out.end(), {all.at(loop).file, all.at(loop).line});
  return out;
}

}  // namespace afterglow
