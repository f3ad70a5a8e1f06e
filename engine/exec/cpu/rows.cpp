// SPDX-License-Identifier: MIT
#include "exec/cpu/rows.h"

namespace afterglow {

int rows_that_pay(const KernelDesc& kernel, int wanted) {
  constexpr double kWorthwhile = 1.5;  // times fewer reads
  constexpr int kMostLines = 12;       // that a processor fetches ahead at a time
  constexpr int kMostReads = 512;      // of texels, over all rows: each is an instruction to compile
  if (kernel.sample || kernel.config.hardware_filter) return 1;
  // Loops cannot be taken in turns: it would be so many times as much to compile for nothing.
  // Variables of file scope would go from row to row with what the row before left in them.
  for (const auto& stage : kernel.stages)
    if (stage.shader->loops || stage.shader->keeps_state) return 1;
  if (!kernel.filter) return wanted;
  for (int rows = wanted; rows > 1; rows /= 2) {
    const auto read = rows_shared(*kernel.filter, kernel.ratio_y, rows);
    if (read && read->lines <= kMostLines && read->apart > kWorthwhile * read->together && read->apart <= kMostReads)
      return rows;
  }
  return 1;
}

}  // namespace afterglow
