// SPDX-License-Identifier: MIT
// What every stack needs on drivers that run shaders on the CPU, whatever the calibration says.
#pragma once

#include "shader/execution_config.h"

namespace afterglow {

void fit_to_cpu_driver(ExecutionConfig& config);

}  // namespace afterglow
