// SPDX-License-Identifier: MIT
#include "exec/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>

#include "core/parallel.h"
#include "exec/cpu/image_reads.h"
#include "exec/cpu/rows.h"
#include "graph/history.h"

namespace afterglow {

namespace {

AxisRatio axis_ratio(int source, int target) {
  if (source == target) return AxisRatio::same;
  if (source == 2 * target) return AxisRatio::half;
  if (2 * source == target) return AxisRatio::twice;
  if (4 * source == target) return AxisRatio::fourfold;
  return AxisRatio::any;
}

Result<KernelStage> stage_of(ShaderLibrary& shaders, const Pass& pass, bool compute = false) {
  auto shader = shaders.find(compute && !pass.by_workgroups.empty() ? pass.by_workgroups : pass.shader);
  if (!shader) {
    Error error = std::move(shader).error();
    if (error.file.empty()) error.file = pass.file, error.line = pass.line;
    return error;
  }
  return KernelStage{.shader = std::move(shader).value(),
                     .constants = pass.constants,
                     .label = pass.name,
                     .straight = pass.straight,
                     .lights_black = pass.lights_black};
}

/// Images that stages of a kernel read at the own pixel: by which stage and input first.
using OwnReads = std::map<ImageId, std::pair<int, std::string>>;

/// Where stage `number` of the kernel, which is `pass`, gets its colour and its pixel-wise inputs.
void connect(const Graph& graph, const PlanKernel& kernel, const Pass& pass, int number, OwnReads& own_reads,
             KernelStage& stage) {
  for (const auto& input : pass.inputs) {
    if (!reads_own_pixel(pass, input)) continue;
    const bool is_color = &input == &pass.inputs.front();
    const auto value = value_in(graph, kernel, input.image);
    if (is_color) stage.color = value.value_or(kOwnImage);
    if (value) {
      if (!is_color) stage.values[input.name] = *value;
      continue;
    }
    const auto [first, is_new] = own_reads.try_emplace(input.image, number, input.name);
    if (!is_new) stage.again[input.name] = first->second;
  }
}

}  // namespace

Result<KernelDesc> describe_kernel(ShaderLibrary& shaders, const Graph& graph, const PlanKernel& kernel,
                                   const ProgramOptions& options) {
  KernelDesc desc;
  desc.config = options.config;
  desc.config.rows = 1;
  desc.config.dispatched = kernel.dispatched;
  const bool half = options.config.storage == Storage::fp16 && !is_precise(graph, kernel.output);
  desc.target = half ? KernelTarget::float16 : KernelTarget::float32;
  desc.target_channels = stored_channels(graph, kernel.output, options.config);
  if (options.unorm8 && kernel.output == graph.result) desc.target = KernelTarget::unorm8;
  const long long pixels = graph.images[kernel.output].size.area();
  const Pass& anchor = graph.passes[kernel.passes.front()];
  std::size_t first_stage = 1;
  if (anchor.kind == PassKind::filter) {
    const Size source = graph.images[anchor.inputs.front().image].size, target = graph.images[anchor.output].size;
    desc.filter = anchor.filter;
    desc.filter_channels = graph.images[anchor.output].channels;
    if (pixels >= options.worth.ratio) {
      desc.ratio_x = axis_ratio(source.width, target.width);
      desc.ratio_y = axis_ratio(source.height, target.height);
    } else if (source == target) {
      desc.ratio_x = desc.ratio_y = AxisRatio::same;
    }
  } else if (info_of(anchor.kind).begins) {
    AFTERGLOW_TRY(desc.sample, stage_of(shaders, anchor, kernel.workgroups));
    desc.sample->channels = graph.images[anchor.output].channels;
    desc.sample->reach = anchor.reach;
  } else {
    first_stage = 0;
  }
  OwnReads own_reads;
  for (std::size_t i = first_stage; i < kernel.passes.size(); ++i) {
    const Pass& pass = graph.passes[kernel.passes[i]];
    AFTERGLOW_TRY(KernelStage stage, stage_of(shaders, pass));
    stage.channels = graph.images[pass.output].channels;
    connect(graph, kernel, pass, static_cast<int>(desc.stages.size()) + (desc.sample ? 1 : 0), own_reads, stage);
    desc.stages.push_back(std::move(stage));
  }
  // What has no stages hands on by itself, unless it must tell what half floats do not hold.
  if (options.flag_non_finite && kernel.output == graph.result)
    desc.finite_check = FiniteCheck::flag;
  else if (options.flag_non_finite && (half || !desc.stages.empty()))
    desc.finite_check = FiniteCheck::propagate;
  if (options.config.storage_reads) desc.reads = storage_reads_of(graph, kernel, desc, options);
  if (pixels >= options.worth.rows) desc.config.rows = rows_that_pay(desc, options.config.rows);
  return desc;
}

const PassInput* input_of(const Pass& pass, const std::string& name) {
  const auto found = std::ranges::find(pass.inputs, name, &PassInput::name);
  return found == pass.inputs.end() ? nullptr : &*found;
}

const Pass& pass_of_stage(const Graph& graph, const PlanKernel& kernel, int stage) {
  // A filter anchor is no stage: stage 0 is then the second pass. The anchor's source (stage -1) is the first pass's.
  const bool filter = graph.passes[kernel.passes.front()].kind == PassKind::filter;
  const int index = stage < 0 ? 0 : stage + (filter ? 1 : 0);
  return graph.passes[kernel.passes[static_cast<std::size_t>(index)]];
}

bool may_compile_apart(const Error& error, const ExecutionConfig& config) {
  return error.kind == ErrorKind::script && config.fusion == Fusion::all;
}

Result<std::vector<ImageId>> images_of_slots(const Graph& graph, const PlanKernel& kernel,
                                             const CompiledKernel& compiled) {
  std::vector<ImageId> images;
  for (const auto& slot : compiled.images) {
    const Pass& pass = pass_of_stage(graph, kernel, slot.stage);
    const PassInput* input = input_of(pass, slot.name);
    if (!input) {
      return Error{ErrorKind::script, fmt::format("pass '{}' lacks the input '{}' of its shader", pass.name, slot.name),
                   pass.file, pass.line};
    }
    images.push_back(input->image);
  }
  return images;
}

Result<CompiledKernels> compile_kernels(KernelCompiler& compiler, const std::vector<KernelDesc>& kernels) {
  // Most levels of a pyramid are described alike, and what is not may still come to one text.
  std::vector<const KernelDesc*> descs;
  std::vector<std::size_t> desc_of;
  for (const auto& kernel : kernels) {
    const auto same = std::ranges::find_if(descs, [&](const KernelDesc* d) { return same_kernel(*d, kernel); });
    desc_of.push_back(static_cast<std::size_t>(same - descs.begin()));
    if (same == descs.end()) descs.push_back(&kernel);
  }
  std::vector<std::optional<Result<AssembledKernel>>> texts(descs.size());
  parallel_for(descs.size(), [&](std::size_t i) { texts[i].emplace(assemble(*descs[i])); });
  std::map<Hash, int> seen;
  std::vector<int> unique_of;
  std::vector<std::size_t> order;  // of what is compiled, by its place in `descs`
  for (std::size_t i = 0; i < descs.size(); ++i) {
    if (!*texts[i]) return std::move(*texts[i]).error();
    const auto [at, is_new] = seen.emplace(texts[i]->value().hash, static_cast<int>(order.size()));
    if (is_new) order.push_back(i);
    unique_of.push_back(at->second);
  }
  CompiledKernels out;
  for (const auto desc : desc_of) out.index.push_back(unique_of[desc]);
  std::vector<std::optional<Result<CompiledKernel>>> results(order.size());
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return texts[i]->value().glsl.size(); });
  parallel_tasks(order.size(), [&](std::size_t k) {
    const std::size_t i = order[k];
    results[static_cast<std::size_t>(unique_of[i])].emplace(compiler.compile(*descs[i], std::move(*texts[i]).value()));
  });
  for (auto& result : results) {
    if (!*result) return std::move(*result).error();
    out.unique.push_back(std::move(*result).value());
  }
  return out;
}

}  // namespace afterglow
