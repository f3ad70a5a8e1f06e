// SPDX-License-Identifier: MIT
// Parameters that come from the vertex shader. Internal to the room; see flat_parameters in shader/kernel.h.
//
// lavapipe reads a number of a uniform block for each pixel by itself, and asks for each whether it lies inside the
// block: some thirty instructions for eight pixels (Mesa 22.3). What a vertex shader hands on, without interpolation,
// is one.
#pragma once

#include "shader/kernel.h"
