// SPDX-License-Identifier: MIT
// Images that are handed from frame to frame: what follows from a graph's histories. Pure functions.
//
// A frame that follows another reads, as `previous`, what that one made as `next`. A frame that follows none (the first
// one, after a seek, after a change of the effect) reads `first` or `initial` instead. Nothing else of earlier frames
// reaches a picture.
#pragma once

#include <vector>

#include "core/hash.h"
#include "graph/graph.h"

namespace afterglow {

/// The history whose `previous` this image is, or null.
const History* history_of_previous(const Graph& graph, ImageId image);
/// The history whose `next` this image is, or null.
const History* history_of_next(const Graph& graph, ImageId image);

/// Whether the image is stored in full floats by itself: of what a history keeps the history says so, of others
/// GraphImage::precise. Never the result.
bool is_precise(const Graph& graph, ImageId image);

/// The images that a pass may read: its inputs, and the `first` of each history among them.
std::vector<ImageId> images_read(const Graph& graph, const Pass& pass);

/// Leaves out histories that never reach the result, with the passes that only served them; each is among `skipped`.
/// Run once, on the whole graph: what is left has to be made in every frame, since a later one needs it.
void drop_unread_histories(Graph& graph);

/// Makes sure that the result is an image of its own: where a history keeps it or is made of it, or where it is the
/// source although histories have to be made, a pass that copies it is added; also where it is another picture of the
/// frame or what the frame before made, and where a compute pass makes it, since callers' images are drawn to.
void separate_result(Graph& graph);
/// `wanted`, or "WANTED#2" and so on where a pass or an image has that name.
std::string unused_name(const Graph& graph, const std::string& wanted);
/// Makes the result a copy of what it was, by a pass of its own: everything else then runs as it does behind the last
/// effect of a stack.
void copy_result(Graph& graph, const std::string& effect);

/// How many earlier frames a frame needs: that of the effect with the longest history, and as many more as the
/// histories of other effects ask for, because one may work on what another made. 0 without histories.
int pre_roll(const Graph& graph);

/// Equal where the part of the graph that makes the history, of the passes of its effect, is the same but for
/// parameters and the numbers of filters: its pixels then mean the same.
Hash history_part(const Graph& graph, const History& history);

}  // namespace afterglow
