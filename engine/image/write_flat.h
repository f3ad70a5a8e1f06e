// Writes the formats without layers and windows, through OpenImageIO.
#pragma once

#include "core/diagnostics.h"
#include "image/output_file.h"
#include "image/output_format.h"
#include "image/writer.h"

namespace afterglow {

/// PNG, JPEG, TIFF, HDR: the display window, encoded as the format and sample type want it. With `out` null the library opens file
/// `name` itself, and what it wrote is read back. May throw what OpenImageIO throws.
Result<void> write_flat(const Picture& picture, const OutputFormat& format, OutputFile* out, const std::string& name,
                        const WriteOptions& options, Diagnostics& diagnostics);

}  // namespace afterglow
