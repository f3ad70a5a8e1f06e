// SPDX-License-Identifier: MIT
// Writes JPEG, TIFF, HDR, DPX, Targa, WebP and JPEG 2000 through OpenImageIO.
#pragma once

#include "image/output_file.h"
#include "image/output_format.h"
#include "image/writer.h"

namespace afterglow {

/// See OiioModule::write.
Result<void> write_with_oiio(const Picture& picture, const OutputFormat& format, OutputFile& out,
                             const std::string& name, const WriteOptions& options);

}  // namespace afterglow
