// SPDX-License-Identifier: MIT
// A request as a chain of OpenColorIO's transforms, its names checked. For the module with OpenColorIO alone.
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include "image/ocio.h"

namespace afterglow {

namespace OCIO = OCIO_NAMESPACE;

/// Thrown by the functions below.
struct OcioFault {
  OcioSurvey::Fault fault;
};

/// The configuration that a request names. Throws OpenColorIO's exceptions.
OCIO::ConstConfigRcPtr open_ocio(const OcioRequest& request);

/// Throws OcioFault.
OCIO::ConstGroupTransformRcPtr ocio_chain(const OCIO::Config& config, const OcioRequest& request);

/// The files that the chain refers to, along all spaces, views and looks that it goes through. Throws Unsupported:
/// spaces that are made of themselves, which OpenColorIO would follow until the stack is full; too much of them.
std::vector<OcioSurvey::File> ocio_files(const OCIO::Config& config, const OCIO::GroupTransform& chain);

/// Whether all of these are there.
bool has_files(const OCIO::Config& config, const OCIO::ConstTransformRcPtr& transform);

/// "+a, -b | c" as OpenColorIO reads it: the names of each choice. It takes the first one whose files are all there.
std::vector<std::vector<std::string>> look_choices(const std::string& looks);

}  // namespace afterglow
