// SPDX-License-Identifier: MIT
// One preset at one size under several choices: prepared first, then measured in turns.
#pragma once

#include "bench/prepared_stack.h"
#include "bench/results.h"

namespace afterglow::bench {

struct CellRequest {
  std::filesystem::path preset;
  StackOptions base;  ///< overrides, search path, allowed error, cache; `choice` is that of each variant
  std::vector<Variant> variants;
  const Picture* picture = nullptr;
  int repeat = 9;
  bool quality = true;  ///< compare with the truth, up to kMostPixelsForTruth
  bool visible = true;  ///< and tell what people would see, which takes longer than all else
  bool passes = true;   ///< time each kernel
};

/// Double precision takes 32 bytes a sample and several images.
inline constexpr long long kMostPixelsForTruth = 1 << 24;

/// Called before each step of the work with what comes next; an error ends the work.
using Step = std::function<Result<void>(const std::string& what)>;

/// Errors: script, usage, device, io, those of `step`.
Result<Cell> measure_cell(Device& device, const CellRequest& request, Diagnostics& diagnostics, const Step& step);

}  // namespace afterglow::bench
