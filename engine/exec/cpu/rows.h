// SPDX-License-Identifier: MIT
// Several rows of the target an invocation, for drivers that run shaders on the CPU: what neighbouring rows both read
// is read once.
#pragma once

#include "shader/kernel.h"

namespace afterglow {

/// How many rows of the target an invocation of this kernel should make, of at most `wanted`: several where
/// neighbouring rows read mostly the same texels, and where there is but a pixel's own colour to work on. Of a sample
/// shader it is a wish: whether its rows share what they read is known when it is compiled (CompiledKernel).
int rows_that_pay(const KernelDesc& kernel, int wanted);

}  // namespace afterglow
