// SPDX-License-Identifier: MIT
// Writes Cineon (Kodak's Digital Film format, version 4.5): OpenImageIO reads it and does not write it.
#pragma once

#include "image/output_file.h"
#include "image/strips.h"

namespace afterglow {

/// The display window as 10-bit RGB, three samples in 32 bits, big-endian. `form` without alpha. Failures are found in
/// `out`.
Result<void> write_cineon(const Picture& picture, const StripForm& form, OutputFile& out);

}  // namespace afterglow
