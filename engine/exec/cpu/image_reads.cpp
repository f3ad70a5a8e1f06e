// SPDX-License-Identifier: MIT
#include "exec/cpu/image_reads.h"

#include "exec/describe.h"
#include "graph/history.h"

namespace afterglow {
namespace {

/// How an image is best read: as a storage image where it is one.
ImageRead read_of(const Graph& graph, ImageId image, const ProgramOptions& options) {
  if (graph.images[image].data) return ImageRead::storage_rgba32f;  // whatever the stack's own images are
  const History* history = history_of_previous(graph, image);
  const bool between = history || graph.images[image].producer >= 0;
  if (!between && !options.inputs_are_storage) return ImageRead::sampled;
  if (!between && image != graph.source) {
    const auto channels = known_channels(graph.images[image].name);
    if (!channels) return ImageRead::sampled;
    return channels == 1 ? ImageRead::storage_r32f : ImageRead::storage_rgba32f;
  }
  const bool half = options.config.storage == Storage::fp16 && !is_precise(graph, image);
  const int channels = stored_channels(graph, image, options.config);
  const ImageRead read = channels == 1   ? half ? ImageRead::storage_r16f : ImageRead::storage_r32f
                         : channels == 2 ? half ? ImageRead::storage_rg16f : ImageRead::storage_rg32f
                         : half          ? ImageRead::storage_rgba16f
                                         : ImageRead::storage_rgba32f;
  // In a first frame another image stands in the same place.
  if (history && history->first != kNoImage && read_of(graph, history->first, options) != read)
    return ImageRead::sampled;
  return read;
}

}  // namespace

std::vector<ImageRead> storage_reads_of(const Graph& graph, const PlanKernel& kernel, const KernelDesc& desc,
                                        const ProgramOptions& options) {
  std::vector<ImageRead> reads;
  const auto add = [&](int stage, const std::string& name) {
    const PassInput* input = input_of(pass_of_stage(graph, kernel, stage), name);
    reads.push_back(input ? read_of(graph, input->image, options) : ImageRead::sampled);
  };
  if (desc.filter && desc.config.hardware_filter)
    reads.push_back(ImageRead::sampled);  // the sampler interpolates
  else if (!desc.sample)
    add(-1, "source");
  int stage = 0;
  const auto add_inputs = [&](const KernelStage& of) {
    if (of.color == kOwnImage && !of.again.contains("source")) add(stage, "source");
    for (const auto& input : of.shader->interface.inputs)
      if (!of.values.contains(input.name) && !of.again.contains(input.name)) add(stage, input.name);
    ++stage;
  };
  if (desc.sample) add_inputs(*desc.sample);
  for (const auto& of : desc.stages) add_inputs(of);
  int left = options.most_storage_reads;
  for (ImageRead& read : reads)
    if (read != ImageRead::sampled && left-- <= 0) read = ImageRead::sampled;
  return reads;
}

}  // namespace afterglow
