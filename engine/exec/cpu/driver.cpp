// SPDX-License-Identifier: MIT
#include "exec/cpu/driver.h"

namespace afterglow {

void fit_to_cpu_driver(ExecutionConfig& config) {
  config.defeat_uniform_inlining = config.two_draws = config.flat_parameters = true;
}

}  // namespace afterglow
