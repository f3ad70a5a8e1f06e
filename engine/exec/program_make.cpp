// SPDX-License-Identifier: MIT
// Makes what a Program is made of.
#include <fmt/format.h>

#include <algorithm>

#include "exec/cpu/driver.h"
#include "exec/cpu/rows.h"
#include "exec/few_channels.h"
#include "exec/program_state.h"
#include "gpu/error.h"
#include "gpu/image.h"
#include "gpu/pipeline.h"
#include "graph/history.h"

namespace afterglow {

/// What the device and the other options leave of the wished execution.
void Program::State::settle_config() {
  ExecutionConfig& config = options.config;
  if (options.reference) {
    config.fusion = Fusion::none;
    config.share_memory = config.hardware_filter = config.compute = config.dispatched = false;
    config.rows = 1;
  }
  format = config.storage == Storage::fp16 ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
  const auto filters = [&](VkFormat of) {
    return supports(device, of, VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT);
  };
  // Pictures, tables and some histories are full floats whatever images between passes are.
  config.hardware_filter = config.hardware_filter && filters(format) && filters(VK_FORMAT_R32_SFLOAT) &&
                           filters(VK_FORMAT_R32G32B32A32_SFLOAT);
  config.storage_reads = config.storage_reads && supports(device, format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT);
  // One of them is what a compute kernel writes. A fragment shader may have so many together with its targets and the
  // word of its loops.
  const VkPhysicalDeviceLimits& limits = device.properties().limits;
  const auto most = [](std::uint32_t limit) { return static_cast<int>(std::min(limit, 1024u)); };
  options.most_storage_reads =
      std::min({options.most_storage_reads, most(limits.maxPerStageDescriptorStorageImages) - 1,
                most(limits.maxFragmentCombinedOutputResources) - (config.dispatched ? 1 : config.rows) - 1});
  config.four_channels = config.four_channels || !holds_few_channels(device, graph, config);
  if (device.is_cpu()) fit_to_cpu_driver(config);
  config.two_draws = config.two_draws && !options.reference;
  config.guard_loops = device.stores_from_fragments();
}

/// Passes that have two ways are drawn where a device is too small for the workgroups of the other. What they share is
/// known once they are compiled (`share_too_much`).
void Program::State::settle_workgroups(ShaderLibrary& shaders) {
  const auto fits = [&](const Pass& pass) {
    if (pass.by_workgroups.empty()) return true;
    const auto shader = shaders.find(pass.by_workgroups);
    const auto* group = shader && (*shader)->interface.workgroup ? &*(*shader)->interface.workgroup : nullptr;
    return !group || check_workgroup(device, group->invocations, 0, pass.name);
  };
  options.config.compute = options.config.compute && std::ranges::all_of(graph.passes, fits);
}

/// Workgroups of passes that have two ways share more than the device allows.
bool Program::State::share_too_much() const {
  const std::uint64_t allowed = device.properties().limits.maxComputeSharedMemorySize;
  for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
    const bool two_ways = !graph.passes[plan.kernels[i].passes.front()].by_workgroups.empty();
    if (plan.kernels[i].workgroups && two_ways && compiled_of(i).shared_bytes > allowed) return true;
  }
  return false;
}

/// The linear image that a result by rows is.
ImageDesc Program::State::result_desc() const {
  return {.name = "result",
          .size = graph.images[graph.result].size,
          .format = result_format(),
          .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
          .tiling = VK_IMAGE_TILING_LINEAR};
}

bool Program::State::may_store_result() const {
  return options.result_stored && options.config.dispatched &&
         supports(device, result_format(), VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT);
}

bool Program::State::stores_result() const {
  return std::ranges::any_of(
      plan.kernels, [this](const PlanKernel& kernel) { return kernel.dispatched && kernel.output == graph.result; });
}

VkImageLayout Program::State::target_layout(ImageId output) const {
  if (history_of_next(graph, output)) return VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  const bool general = output == graph.result ? result_rows > 1 : linear;
  return general ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
}

VkFormat Program::State::image_format(ImageId image) const {
  if (image == graph.result) return result_format();
  return float_format(stored_channels(graph, image, options.config),
                      options.config.storage == Storage::fp16 && !is_precise(graph, image));
}

/// What the device must be able to do, before anything is made.
Result<void> Program::State::check() {
  if (graph.result != graph.source && graph.images[graph.result].producer < 0) {
    return Error{ErrorKind::other, fmt::format("the result '{}' is an input", graph.images[graph.result].name)};
  }
  for (const auto& kernel : plan.kernels) {
    const GraphImage& image = graph.images[kernel.output];
    const VkImageUsageFlags stored = kernel.dispatched ? VK_IMAGE_USAGE_STORAGE_BIT : 0;
    AFTERGLOW_CHECK(
        check_image(device, {.name = image.name,
                             .size = image.size,
                             .format = image_format(kernel.output),
                             .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | stored}));
  }
  return {};
}

Result<std::vector<KernelDesc>> Program::State::describe(ShaderLibrary& shaders) {
  std::vector<KernelDesc> descs;
  for (const auto& kernel : plan.kernels) {
    AFTERGLOW_TRY(KernelDesc desc, describe_kernel(shaders, graph, kernel, options));
    descs.push_back(std::move(desc));
  }
  return descs;
}

ArenaOptions Program::State::arena_options(const std::vector<KernelDesc>& descs) const {
  ArenaOptions wanted{.half = options.config.storage == Storage::fp16,
                      .channels = {},
                      .share = options.config.share_memory && !options.keep_images,
                      .readable = options.reference,
                      .storage = options.config.storage_reads,
                      .stored = {},
                      .rows = {},
                      .max_memory = options.max_memory};
  for (std::size_t id = 0; id < graph.images.size(); ++id)
    wanted.channels.push_back(stored_channels(graph, static_cast<ImageId>(id), options.config));
  for (const auto& kernel : plan.kernels)
    if (kernel.dispatched) wanted.stored.insert(kernel.output);
  if (linear)
    for (const auto& desc : descs) wanted.rows.push_back(desc.config.dispatched ? 1 : desc.config.rows);
  return wanted;
}

/// Whether the device can draw into linear images between kernels, all of them: they share layouts and barriers.
bool Program::State::can_be_linear() const {
  ArenaOptions wanted = arena_options({});
  wanted.rows.assign(plan.transient.size(), 1);
  return std::ranges::all_of(plan.transient, [&](ImageId id) {
    return id == graph.result || history_of_next(graph, id) || check_image(device, Arena::desc_of(graph, id, wanted));
  });
}

/// Whether rows that are but a wish pay is known once they are compiled.
Result<void> Program::State::settle_rows(KernelCompiler& compiler, std::vector<KernelDesc>& descs) {
  std::vector<KernelDesc> tried;
  for (const auto& desc : descs)
    if (rows_are_a_wish(desc)) tried.push_back(desc);
  if (tried.empty()) return {};
  AFTERGLOW_TRY(const CompiledKernels settled, compile_kernels(compiler, tried));
  std::size_t next = 0;
  for (auto& desc : descs)
    if (rows_are_a_wish(desc) && !settled.unique[settled.index[next++]].rows_pay) desc.config.rows = 1;
  return {};
}

/// How many rows kernels really make at a time, and the images between them, unless those come from a pool.
Result<void> Program::State::make_images(std::vector<KernelDesc>& descs) {
  for (std::size_t i = 0; i < descs.size(); ++i)
    if (history_of_next(graph, plan.kernels[i].output) && !descs[i].config.dispatched) descs[i].config.rows = 1;
  // A compute shader stores its rows one by one.
  const auto by_rows = [](const KernelDesc& desc) { return desc.config.rows > 1 && !desc.config.dispatched; };
  linear = std::ranges::any_of(descs, by_rows) && can_be_linear();
  for (std::size_t i = 0; i < descs.size(); ++i) {
    const ImageId output = plan.kernels[i].output;
    if (plan.kernels[i].dispatched) continue;
    if (output == graph.result) {
      descs[i].config.rows =
          options.result_by_rows ? RowTargets::possible(device, result_desc(), descs[i].config.rows) : 1;
      result_rows = descs[i].config.rows;
    } else if (linear) {
      const ImageDesc desc = Arena::desc_of(graph, output, arena_options(descs));
      descs[i].config.rows = RowTargets::possible(device, desc, descs[i].config.rows);
    } else {
      descs[i].config.rows = 1;
    }
  }
  if (from_pool()) return {};
  AFTERGLOW_TRY(arena, Arena::create(device, graph, plan, arena_options(descs)));
  return {};
}

/// The images between kernels, where those of other programs serve: known once the kernels are.
Result<void> Program::State::take_images(const std::vector<KernelDesc>& descs) {
  if (!from_pool()) return {};
  ArenaOptions wanted = arena_options(descs);
  wanted.pool = options.images;
  wanted.keys = identities;
  AFTERGLOW_TRY(arena, Arena::create(device, graph, plan, wanted));
  return {};
}

/// What a kernel that binds these images may read besides histories, which are ready to be read as soon as they are
/// made.
std::vector<ImageId> Program::State::reads_of(const std::vector<ImageId>& bound) const {
  std::vector<ImageId> out;
  for (const ImageId image : bound) {
    const History* history = history_of_previous(graph, image);
    const ImageId read = history ? history->first : image;
    if (read != kNoImage && !history_of_next(graph, read)) out.push_back(read);
  }
  return out;
}

Result<void> Program::State::compile(KernelCompiler& compiler, const std::vector<KernelDesc>& descs) {
  AFTERGLOW_TRY(compiled, compile_kernels(compiler, descs));
  std::vector<const CompiledKernel*> pointers;
  for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
    AFTERGLOW_TRY(std::vector<ImageId> bind, images_of_slots(graph, plan.kernels[i], compiled_of(i)));
    reads.push_back(reads_of(bind));
    if (plan.kernels[i].dispatched) bind.push_back(plan.kernels[i].output);
    images.push_back(std::move(bind));
    pointers.push_back(&compiled_of(i));
  }
  AFTERGLOW_TRY(data, DataImages::create(device, graph, options.config.storage_reads));
  AFTERGLOW_TRY(sampler, create_sampler(device, VK_FILTER_NEAREST));
  if (options.config.hardware_filter) {
    AFTERGLOW_TRY(interpolating, create_sampler(device, VK_FILTER_LINEAR));
  }
  AFTERGLOW_TRY(parameters, ParameterBuffer::create(device, graph, plan, pointers));
  AFTERGLOW_TRY(loops, LoopWatch::create(device, plan, pointers));
  return {};
}

/// All that compiling decides.
Result<void> Program::State::settle_and_compile(KernelCompiler& compiler, std::vector<KernelDesc>& descs) {
  AFTERGLOW_CHECK(settle_rows(compiler, descs));
  AFTERGLOW_CHECK(make_images(descs));
  return compile(compiler, descs);
}

Result<void> Program::State::make_pipelines() {
  std::vector<std::string> names(compiled.unique.size());
  for (std::size_t i = plan.kernels.size(); i-- > 0;) names[compiled.index[i]] = plan.kernels[i].name;
  AFTERGLOW_TRY(pipelines,
                KernelPipelines::create(device, compiled.unique, names, VK_FORMAT_UNDEFINED, options.pipelines));
  return {};
}

/// One for all kernels with two draws: they run one after another.
Result<void> Program::State::make_marks() {
  Size size;
  for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
    if (!compiled_of(i).two_draws) continue;
    const Size target = graph.images[plan.kernels[i].output].size;
    size = {std::max(size.width, target.width), std::max(size.height, target.height)};
  }
  if (size.width == 0) return {};
  AFTERGLOW_TRY(marks, GpuImage::create(device, {.name = "marks",
                                                 .size = size,
                                                 .format = kDepthFormat,
                                                 .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT}));
  return {};
}

/// Uniform blocks and transient images stay for good; inputs are written by `bind`, histories by `use`.
/// Of one more frame in flight, with what is the same for all of them.
Result<void> Program::State::make_place() {
  std::vector<SetNeeds> needs;
  for (int which = 0; which < sets(); ++which)
    for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
      const CompiledKernel& kernel = compiled_of(i);
      needs.push_back({.layout = pipelines.layout(kernel).set.get(),
                       .block = {parameters.buffer(), parameters.offset(i), kernel.block_size},
                       .images = descriptor_types(kernel)});
    }
  Place place;
  AFTERGLOW_TRY(place.descriptors, Descriptors::create(device, needs));
  for (int which = 0; which < sets(); ++which)
    for (std::size_t i = 0; i < plan.kernels.size(); ++i)
      if (const auto word = loops.word(i))
        place.descriptors.write_buffer(set_index(which, i), needs[i].images.size() - 1, *word);
  for (int which = 0; which < sets(); ++which) write_set(place, which, [this](ImageId id) { return look_between(id); });
  if (histories) show_histories(place);
  places.push_back(std::move(place));
  return {};
}

/// Those given, or the program's own.
Result<void> Program::State::make_histories() {
  if (graph.histories.empty()) return {};
  histories = options.histories;
  if (histories) return {};
  histories = std::make_shared<Histories>();
  const std::uint64_t left = options.max_memory - std::min(options.max_memory, arena.memory().arena);
  return histories->fit(device, graph, Histories::options_for(device, graph, options.config, left));
}

/// Pixels that kernels make together.
std::vector<Size> Program::State::blocks() const {
  std::vector<Size> out;
  for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
    const CompiledKernel& kernel = compiled_of(i);
    out.push_back(kernel.workgroup ? kernel.workgroup->pixels : Size{1, kernel.rows});
  }
  return out;
}

/// What each kernel draws, once they are compiled.
Result<void> Program::State::find_parts() {
  const auto whole = [this](ImageId id) {
    return Rect{0, 0, graph.images[id].size.width, graph.images[id].size.height};
  };
  if (options.region) {
    const Rect &part = *options.region, all = whole(graph.result);
    if (part.width < 1 || part.height < 1 || part.x < 0 || part.y < 0 || part.x + part.width > all.width ||
        part.y + part.height > all.height)
      return Error{ErrorKind::other, "the region is not within the picture"};
    parts = regions(graph, plan, part, blocks());
    return {};
  }
  for (const auto& kernel : plan.kernels) parts.kernels.push_back(whole(kernel.output));
  for (std::size_t i = 0; i < graph.images.size(); ++i) parts.images.push_back(whole(static_cast<ImageId>(i)));
  return {};
}

}  // namespace afterglow
