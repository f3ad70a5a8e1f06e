// SPDX-License-Identifier: MIT
// The last step to an 8-bit display file, as a pass of the graph.
#pragma once

#include "graph/graph.h"

namespace afterglow {

/// 8-bit display codes as the last kernel's work: sRGB-encoded, as a display file holds them.
struct DisplayEncoding {
  bool straight_alpha = false;  ///< colours are divided by the source's alpha, which becomes the codes' alpha
  bool dither = false;          ///< blue noise between two codes
  friend bool operator==(const DisplayEncoding&, const DisplayEncoding&) = default;
};

/// Adds a pixel pass behind the result, which joins the last kernel like any other.
void encode_for_display(Graph& graph, const DisplayEncoding& encoding);

}  // namespace afterglow
