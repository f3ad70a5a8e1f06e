// SPDX-License-Identifier: MIT
#include "exec/cpu/rows.h"

#include <algorithm>

namespace afterglow {
namespace {

bool may_take_turns(const KernelStage& stage) { return !stage.shader->open_loops && !stage.shader->keeps_state; }

}  // namespace

int rows_that_pay(const KernelDesc& kernel, int wanted) {
  constexpr double kWorthwhile = 1.5;  // times fewer reads
  constexpr int kMostLines = 12;       // that a processor fetches ahead at a time
  constexpr int kMostReads = 512;      // of texels, over all rows: each is an instruction to compile
  constexpr double kMostReach = 4;     // of a sample shader: beyond, rows share less and less
  constexpr int kMostOfSamples = 4;    // rows of one: more read so many lines that they push each other out of a cache
  if (kernel.config.hardware_filter) return 1;
  // Loops that do not count cannot be taken in turns: it would be so many times as much to compile for nothing.
  // Variables of file scope would go from row to row with what the row before left in them.
  for (const auto& stage : kernel.stages)
    if (!may_take_turns(stage)) return 1;
  if (kernel.sample) {
    const ShaderInterface& shader = kernel.sample->shader->interface;
    const bool may_share =
        !shader.done && !shader.workgroup && kernel.sample->reach.value_or(kMostReach + 1) <= kMostReach;
    return may_share && may_take_turns(*kernel.sample) ? std::min(wanted, kMostOfSamples) : 1;
  }
  if (!kernel.filter) return wanted;
  for (int rows = wanted; rows > 1; rows /= 2) {
    const auto read = rows_shared(*kernel.filter, kernel.ratio_y, rows);
    if (read && read->lines <= kMostLines && read->apart > kWorthwhile * read->together && read->apart <= kMostReads)
      return rows;
  }
  return 1;
}

bool rows_are_a_wish(const KernelDesc& kernel) {
  const auto loops = [](const KernelStage& stage) { return stage.shader->loops; };
  return kernel.config.rows > 1 && (kernel.sample || std::ranges::any_of(kernel.stages, loops));
}

}  // namespace afterglow
