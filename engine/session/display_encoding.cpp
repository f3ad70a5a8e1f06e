#include "session/display_encoding.h"

namespace afterglow {

void encode_for_display(Graph& graph, const DisplayEncoding& encoding) {
  const auto output = static_cast<ImageId>(graph.images.size());
  Pass pass;
  pass.name = "output.display";
  pass.effect = "output";
  pass.shader = encoding.straight_alpha ? "output/display_straight" : "output/display";
  pass.inputs = {{"source", graph.result}};
  if (encoding.straight_alpha) pass.inputs.push_back({"original", graph.source, true});
  pass.constants = {{"dither", encoding.dither ? 1.0 : 0.0}};
  pass.output = output;
  graph.images.push_back({pass.name, graph.images[graph.result].size, static_cast<int>(graph.passes.size())});
  graph.passes.push_back(std::move(pass));
  graph.result = output;
}

}  // namespace afterglow
