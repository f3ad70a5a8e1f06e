// SPDX-License-Identifier: MIT
// What a frame is given, checked against what its program reads.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "exec/frame.h"
#include "gpu/device.h"

namespace afterglow {

/// Errors: other (the image is missing, of another size than in the graph, or has an impossible number of channels).
Result<void> check_input(const Graph& graph, const std::string& name, ImageId id,
                         const std::map<std::string, HostImage>& inputs);

/// The images that a program reads, by the names of a frame's inputs: "source", "depth", "layer:NAME".
std::map<std::string, ImageId> inputs_of(const Graph& graph);

/// Those images as pictures usually have them, for who wants a program without a frame: their pixels must not be read.
std::map<std::string, HostImage> usual_inputs(const Graph& graph);

/// Everything but the source is stored as full floats, whatever the storage of the stack. Shaders that read an image as
/// a storage image name its format: what a name tells (`known_channels`) counts more than the channels that are given.
VkFormat input_format(const std::string& name, int channels, VkFormat storage);

/// The source as RGBA; the result's pixels may be its own memory. Pictures with `read_row` go to a `write_row`.
void copy_source(const HostImage& source, HostResult& out);

}  // namespace afterglow
