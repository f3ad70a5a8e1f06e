#include "graph/changes.h"

#include "graph/history.h"

namespace afterglow {

std::vector<bool> kernels_to_run(const Graph& graph, const Plan& plan, const std::vector<bool>& changed_kernels,
                                 const std::vector<ImageId>& changed_images) {
  std::vector<bool> changed(graph.images.size(), false), run(changed_kernels);
  for (const ImageId image : changed_images) changed[image] = true;
  for (std::size_t k = 0; k < plan.kernels.size(); ++k) {
    for (const int pass : plan.kernels[k].passes)
      for (const ImageId image : images_read(graph, graph.passes[pass])) run[k] = run[k] || changed[image];
    if (run[k]) changed[plan.kernels[k].output] = true;
  }
  return run;
}

}  // namespace afterglow
