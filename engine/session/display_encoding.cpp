// SPDX-License-Identifier: MIT
#include "session/display_encoding.h"

#include "graph/history.h"
#include "image/encode.h"

namespace afterglow {

void encode_for_display(Graph& graph, const DisplayEncoding& encoding) {
  const auto output = static_cast<ImageId>(graph.images.size());
  Pass pass;
  pass.name = unused_name(graph, "output.display");
  pass.effect = "output";
  pass.shader = encoding.straight_alpha ? "output/display_straight" : "output/display";
  if (encoding.dither) pass.shader += "_dithered";
  pass.inputs = {{"source", graph.result}};
  if (encoding.straight_alpha) pass.inputs.push_back({"original", graph.source, true});
  pass.output = output;
  graph.images.push_back({pass.name, graph.images[graph.result].size, static_cast<int>(graph.passes.size())});
  if (encoding.dither) {
    const auto noise = blue_noise_image();
    pass.inputs.push_back({"noise", static_cast<ImageId>(graph.images.size())});
    graph.images.push_back({unused_name(graph, "output.noise"), noise->size, -1, noise});
  }
  graph.passes.push_back(std::move(pass));
  graph.result = output;
}

}  // namespace afterglow
