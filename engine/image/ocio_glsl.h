// SPDX-License-Identifier: MIT
// A processor of OpenColorIO as a pixel shader of ours. For the module with OpenColorIO alone.
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include "image/ocio.h"

namespace afterglow {

/// OpenColorIO's own shader, with its textures in one image that is read texel by texel: its fractions are those of
/// floats, not the eight bits of a texture unit. Throws Unsupported, OpenColorIO's exceptions.
OcioShader ocio_glsl(const OCIO_NAMESPACE::Processor& processor);

}  // namespace afterglow
