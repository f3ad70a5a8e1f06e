// SPDX-License-Identifier: MIT
// A picture as a Renderer takes it.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "exec/frame.h"
#include "graph/graph.h"
#include "image/cryptomatte.h"
#include "image/picture.h"
#include "script/preset.h"

namespace afterglow {

/// "source" and the auxiliary inputs of the graph; they point into the picture.
std::map<std::string, HostImage> picture_inputs(const Picture& picture, const Graph& graph);

/// Warns of an object whose id no pixel of the picture's cryptomattes has: its mask selects nothing.
void warn_if_absent(const CryptomatteObject& object, const Picture& picture, Diagnostics& diagnostics);

/// What scripts may know of the picture's files, which `facts` are of; null: nothing.
void note_files(const std::shared_ptr<const FileFacts>& facts, BuildContext& context);
/// `frame` with the sizes and files of the picture.
BuildContext context_of(const Picture& picture, const BuildContext& frame);

}  // namespace afterglow
