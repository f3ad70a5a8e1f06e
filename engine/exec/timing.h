// SPDX-License-Identifier: MIT
// For those who measure devices rather than make pictures: work that is recorded once and timed, pictures that stay on
// the device, single kernels, and a copy by a compute shader to compare with.
#pragma once

#include "exec/barriers.h"
#include "exec/timing/compute_copy.h"
#include "exec/timing/device_picture.h"
#include "exec/timing/kernel_work.h"
#include "exec/timing/timed_work.h"
