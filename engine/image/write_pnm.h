// SPDX-License-Identifier: MIT
// Writes PPM (P6), PAM (P7) and PFM (PF): a line or two of text, then samples. Files and streams of them.
#pragma once

#include "image/output_file.h"
#include "image/output_format.h"
#include "image/strips.h"

namespace afterglow {

/// The display window. PPM and PAM: integers, big-endian; PAM has straight alpha. PFM: floats, little-endian,
/// scene-linear, rows from the bottom. Failures are found in `out`.
Result<void> write_pnm(const Picture& picture, OutputKind kind, const StripForm& form, OutputFile& out);

}  // namespace afterglow
