// SPDX-License-Identifier: MIT
// What an effect promises of its result: `holds` of fx.effect. Nothing in the engine relies on it; `afterglow stress`
// checks it with pictures and settings that are hard to stand.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "script/preset.h"

namespace afterglow {

/// A promise that effects can make.
struct InvariantKind {
  std::string name;
  std::string main;                        ///< what a bare value stands for: `mean = 1e-3` is { within = 1e-3 }
  std::map<std::string, double> numbers;   ///< its parameters and their defaults; NaN: must be given
  std::vector<std::string> setting_names;  ///< parameters that name a setting of the effect
  std::string doc;                         ///< what is promised
};
/// All of them, in the order of the documents.
const std::vector<InvariantKind>& invariant_kinds();

/// "mean (within 0.001; for some settings)".
std::string invariant_text(const InvariantSchema& hold);

}  // namespace afterglow
