// SPDX-License-Identifier: MIT
// Writes PNG. On its own rather than through libpng: rows are encoded, filtered and packed on several threads, by
// libraries that take a third of zlib's time (image/deflate.h), which is what a PNG costs.
#pragma once

#include "image/output_file.h"
#include "image/strips.h"

namespace afterglow {

/// The display window as 8- or 16-bit RGB or straight RGBA. `level`: 0 to 9. The bytes do not depend
/// on the number of threads. Takes up to twice the bytes of the samples from `memory` (null: anew). Failures are found
/// in `out`.
Result<void> write_png(const Picture& picture, const StripForm& form, OutputFile& out, int level, WorkMemory* memory);

}  // namespace afterglow
