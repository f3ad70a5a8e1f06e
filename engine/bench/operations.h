// SPDX-License-Identifier: MIT
// What single operations on a picture cost on a device, measured in turns.
#pragma once

#include <vector>

#include "bench/calibrate.h"

namespace afterglow::bench {

/// Copies in each format that the device can draw to, filtered against integer fetches, sampled against storage reads,
/// fragment against compute. Errors: device, those of `step`.
Result<std::vector<OperationCost>> measure_operations(Device& device, const StackOptions& base, const Picture& picture,
                                                      int repeat, const Step& step);

}  // namespace afterglow::bench
