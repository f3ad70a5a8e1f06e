// SPDX-License-Identifier: MIT
// Several rows of the target an invocation, for drivers that run shaders on the CPU: what neighbouring rows both read
// is read once.
#pragma once

#include "shader/kernel.h"

namespace afterglow {

/// How many rows of the target an invocation of this kernel should make, of at most `wanted`: several where
/// neighbouring rows read mostly the same texels, and where there is but a pixel's own colour to work on.
int rows_that_pay(const KernelDesc& kernel, int wanted);

/// Whether its rows pay is known when they are compiled (CompiledKernel::rows_pay): rows of a sample shader may share
/// what they read, and loops of a few turns become straight code.
bool rows_are_a_wish(const KernelDesc& kernel);

}  // namespace afterglow
