// SPDX-License-Identifier: MIT
// Waiting for a device.
#pragma once

#include "gpu/device.h"

namespace afterglow {

/// Until `fence` is signalled, however long it takes: drivers end a submission that hangs, as "device lost", and there
/// is nothing useful to do after a shorter time. A wait may run out of memory while the device works on, and what it
/// uses must not be destroyed: then the fence is asked until it answers. (A driver that refuses to for ten seconds is
/// taken for lost. All queues could not be waited for: those of an adopted device belong to its host's threads.)
VkResult wait_for_fence(const Device& device, VkFence fence);

}  // namespace afterglow
