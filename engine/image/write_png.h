// SPDX-License-Identifier: MIT
// Writes PNG. On its own rather than through libpng, so that strips of rows are encoded and compressed on several
// threads: compression is what a PNG costs.
#pragma once

#include "image/output_file.h"
#include "image/strips.h"

namespace afterglow {

/// The display window as 8- or 16-bit RGB or straight RGBA. `level` of zlib. The bytes do not depend on the number of
/// threads. Failures are found in `out`. Errors: io (zlib).
Result<void> write_png(const Picture& picture, const StripForm& form, OutputFile& out, int level);

}  // namespace afterglow
