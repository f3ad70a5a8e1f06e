// A picture as a FrameRunner takes it, and what a frame left undone. Internal to the room.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "exec/frame.h"
#include "graph/graph.h"
#include "image/picture.h"
#include "script/preset.h"

namespace afterglow {

/// "source" and the auxiliary inputs of the graph; they point into the picture.
std::map<std::string, HostImage> picture_inputs(const Picture& picture, const Graph& graph);

/// `frame` with the sizes of the picture.
BuildContext context_of(const Picture& picture, const BuildContext& frame);

/// What a frame did not do because it was done before.
std::vector<Skipped> kept_of(const FrameTimes& times);

}  // namespace afterglow
