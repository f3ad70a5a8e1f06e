// SPDX-License-Identifier: MIT
// A kernel as the compiler of GLSL made it, but for values that its author left out and indices beyond arrays.
#pragma once

#include <gtest/gtest.h>

#include "shader/cpu/defeat_uniform_inlining.h"
#include "shader/give_values.h"
#include "shader/glsl.h"
#include "shader/kernel.h"
#include "shader/spirv_passes.h"

namespace afterglow {

/// `compiled`: what KernelCompiler makes of `desc`.
inline CompiledKernel untouched(const KernelDesc& desc, CompiledKernel compiled) {
  const auto assembled = assemble(desc);
  EXPECT_TRUE(assembled);
  const auto spirv = compile_glsl(assembled->glsl, assembled->file_names);
  EXPECT_TRUE(spirv);
  const auto held = with_held_indices(give_values(*spirv));
  EXPECT_TRUE(held);
  compiled.spirv = desc.config.defeat_uniform_inlining ? defeat_uniform_inlining(*held) : *held;
  compiled.hash = Hasher().add(compiled.hash.hex()).add("untouched").finish();
  return compiled;
}

}  // namespace afterglow
