// SPDX-License-Identifier: MIT
// Waiting for a device.
#pragma once

#include "gpu/device.h"

namespace afterglow {

/// Until `fence` is signalled, however long it takes: drivers end a submission that hangs, as "device lost", and there
/// is nothing useful to do after a shorter time. A wait may run out of memory while the device works on; then this
/// comes back when the device is idle, so that what it used may be destroyed.
VkResult wait_for_fence(const Device& device, VkFence fence);

}  // namespace afterglow
