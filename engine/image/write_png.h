// SPDX-License-Identifier: MIT
// Writes PNG. On its own rather than through libpng: rows are encoded and filtered on several threads, and libdeflate
// packs them in half of zlib's time, which is what a PNG costs.
#pragma once

#include "image/output_file.h"
#include "image/strips.h"

namespace afterglow {

/// The display window as 8- or 16-bit RGB or straight RGBA. `level`: libdeflate's, 0 to 9. The bytes do not depend
/// on the number of threads. Takes up to twice the bytes of the samples from `memory` (null: anew). Failures are found
/// in `out`.
Result<void> write_png(const Picture& picture, const StripForm& form, OutputFile& out, int level, WorkMemory* memory);

}  // namespace afterglow
