// SPDX-License-Identifier: MIT
// Metadata between OpenImageIO's lists and the general form.
#pragma once

#include <OpenImageIO/paramlist.h>

#include "image/metadata.h"

namespace afterglow {

Metadata metadata_of(const OIIO::ParamValueList& list);
OIIO::ParamValueList param_list(const Metadata& metadata);

}  // namespace afterglow
