// SPDX-License-Identifier: MIT
// Where two graphs of one stack differ: what a build that was run again makes otherwise.
#pragma once

#include <optional>
#include <string>

#include "graph/graph.h"

namespace afterglow {

struct Difference {
  std::string effect;  ///< name of the entry that is built otherwise
  std::string what;    ///< "gain of pass 'e.mix' is 0.5, then 0.25"
};

/// The first entry whose passes (their values included), histories or idle conditions differ, or which only one of the
/// graphs leaves out. Empty: none.
std::optional<Difference> first_difference(const Graph& a, const Graph& b);

}  // namespace afterglow
