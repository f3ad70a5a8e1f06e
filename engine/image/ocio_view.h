// A display, a view or a colour space of an OpenColorIO configuration as steps. For the module with OpenColorIO alone.
#pragma once

#include "image/lut_file.h"

namespace afterglow {

/// See read_ocio. Throws Unsupported, OpenColorIO's exceptions.
Lut lut_of_view(const OcioRequest& request);

}  // namespace afterglow
