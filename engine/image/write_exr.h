// SPDX-License-Identifier: MIT
// Writes OpenEXR through OpenEXR itself: exact attributes, both windows, and other layers copied as they are.
#pragma once

#include "core/diagnostics.h"
#include "image/output_file.h"
#include "image/writer.h"

namespace afterglow {

/// A scan-line file with R, G, B[, A]. May throw what OpenEXR throws.
Result<void> write_exr(const Picture& picture, OutputFile& out, const std::string& name, const WriteOptions& options,
                       Diagnostics& diagnostics);

/// The input file again, with the colour of its chosen layer replaced by the picture's; everything else as it was. May
/// throw.
Result<void> write_exr_with_layers(const Picture& picture, OutputFile& out, const std::string& name,
                                   const WriteOptions& options, Diagnostics& diagnostics);

}  // namespace afterglow
