#include "exec/cpu/driver.h"

namespace afterglow {

void fit_to_cpu_driver(ExecutionConfig& config) { config.hide_uniforms = true; }

}  // namespace afterglow
