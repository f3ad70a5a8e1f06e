#include "exec/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <set>

#include "exec/arena.h"
#include "exec/barriers.h"
#include "exec/data_images.h"
#include "exec/describe.h"
#include "exec/descriptors.h"
#include "exec/kernel_pipelines.h"
#include "exec/parameters.h"
#include "exec/record.h"
#include "gpu/error.h"
#include "gpu/pipeline.h"
#include "graph/changes.h"

namespace afterglow {

struct Program::State {
  State(Device& device_in, const Graph& graph_in, const ProgramOptions& options_in)
      : device(device_in), graph(graph_in), options(options_in) {}

  Device& device;
  Graph graph;
  ProgramOptions options;
  VkFormat format = VK_FORMAT_UNDEFINED;
  Plan plan;
  Regions parts;
  std::vector<bool> changed;  ///< kernels with new parameters since the last run; all before the first
  std::uint64_t id = 0;

  CompiledKernels compiled;
  std::vector<std::vector<ImageId>> images;  ///< to bind, parallel to the plan's kernels
  ParameterBuffer parameters;
  Arena arena;
  DataImages data;
  KernelPipelines pipelines;  ///< of compiled.unique
  SamplerHandle sampler;
  Descriptors descriptors;
  std::vector<KernelCommands> kernels;
  KernelBarriers begin;  ///< before the first kernel
  std::vector<VkImageView> result;
  int result_rows = 1;
  bool storage_reads = false;
  bool linear = false;  ///< images between kernels stay in GENERAL
  int bindings = 0;

  /// Images between kernels; one layout for both ways of reading.
  VkImageLayout read_layout() const {
    return storage_reads || linear ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  }
  VkImageLayout source_layout() const {
    return options.source_is_storage && storage_reads ? VK_IMAGE_LAYOUT_GENERAL
                                                      : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  }

  VkImageLayout target_layout(ImageId output) const {
    const bool general = output == graph.result ? result_rows > 1 : linear;
    return general ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  }
  VkFormat result_format() const { return options.codes ? VK_FORMAT_R8G8B8A8_UNORM : format; }
  bool hardware_filter() const;
  ImageDesc result_desc() const;

  const CompiledKernel& compiled_of(std::size_t kernel) const { return compiled.unique[compiled.index[kernel]]; }
  Result<void> check();
  Result<std::vector<KernelDesc>> describe(ShaderLibrary& shaders);
  Result<void> make_images(std::vector<KernelDesc>& descs);
  Result<void> compile(KernelCompiler& compiler, const std::vector<KernelDesc>& descs);
  Result<void> make_pipelines();
  Result<void> make_descriptors();
  void make_commands();
  Result<void> find_parts();
  VkImage barrier_image(ImageId id) const;
  void record_some(VkCommandBuffer commands, const std::vector<bool>& run,
                   const std::function<void(std::size_t)>& stamp) const;
};

namespace {

bool can(const Device& device, VkFormat format, VkFormatFeatureFlags wanted) {
  VkFormatProperties properties{};
  vkGetPhysicalDeviceFormatProperties(device.physical(), format, &properties);
  return (properties.optimalTilingFeatures & wanted) == wanted;
}

}  // namespace

bool Program::State::hardware_filter() const {
  return options.hardware_filter && !options.reference &&
         can(device, format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT);
}

/// The linear image that a result by rows is.
ImageDesc Program::State::result_desc() const {
  return {.name = "result",
          .size = graph.images[graph.result].size,
          .format = result_format(),
          .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
          .tiling = VK_IMAGE_TILING_LINEAR};
}

/// What the device must be able to do, before anything is made.
Result<void> Program::State::check() {
  if (graph.result != graph.source && graph.images[graph.result].producer < 0) {
    return Error{ErrorKind::other, fmt::format("the result '{}' is an input", graph.images[graph.result].name)};
  }
  for (const auto& kernel : plan.kernels) {
    const GraphImage& image = graph.images[kernel.output];
    AFTERGLOW_CHECK(check_image(device, {.name = image.name,
                                         .size = image.size,
                                         .format = kernel.output == graph.result ? result_format() : format,
                                         .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT}));
  }
  return {};
}

Result<std::vector<KernelDesc>> Program::State::describe(ShaderLibrary& shaders) {
  const DescribeOptions describe{.hardware_filter = hardware_filter(),
                                 .half_storage = options.storage == Storage::fp16,
                                 .codes = options.codes,
                                 .storage_reads = storage_reads,
                                 .source_is_storage = options.source_is_storage,
                                 .rows = options.reference ? 1 : options.rows,
                                 .worth = options.worth};
  std::vector<KernelDesc> descs;
  for (const auto& kernel : plan.kernels) {
    AFTERGLOW_TRY(KernelDesc desc, describe_kernel(shaders, graph, kernel, describe));
    descs.push_back(std::move(desc));
  }
  return descs;
}

/// The images between kernels, and how many rows their kernels and the last one really make at a time.
Result<void> Program::State::make_images(std::vector<KernelDesc>& descs) {
  ArenaOptions wanted{.format = format,
                      .share = options.share_memory && !options.reference && !options.keep_images,
                      .readable = options.reference,
                      .storage = storage_reads,
                      .rows = {},
                      .max_memory = options.max_memory};
  linear = std::ranges::any_of(descs, [](const KernelDesc& desc) { return desc.rows > 1; });
  if (linear)
    for (const auto& desc : descs) wanted.rows.push_back(desc.rows);
  AFTERGLOW_TRY(arena, Arena::create(device, graph, plan, wanted));
  for (std::size_t i = 0; i < descs.size(); ++i) {
    const ImageId output = plan.kernels[i].output;
    const RowTargets* targets = arena.row_targets(output);
    if (output == graph.result) {
      descs[i].rows = options.result_by_rows ? RowTargets::possible(device, result_desc(), descs[i].rows) : 1;
      result_rows = descs[i].rows;
    } else {
      descs[i].rows = targets ? targets->rows() : 1;
    }
  }
  return {};
}

Result<void> Program::State::compile(KernelCompiler& compiler, const std::vector<KernelDesc>& descs) {
  AFTERGLOW_TRY(compiled, compile_kernels(compiler, descs));
  std::vector<const CompiledKernel*> pointers;
  for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
    AFTERGLOW_TRY(std::vector<ImageId> bind, images_of_slots(graph, plan.kernels[i], compiled_of(i)));
    images.push_back(std::move(bind));
    pointers.push_back(&compiled_of(i));
  }
  AFTERGLOW_TRY(data, DataImages::create(device, graph, storage_reads));
  AFTERGLOW_TRY(sampler, create_sampler(device, hardware_filter() ? VK_FILTER_LINEAR : VK_FILTER_NEAREST));
  AFTERGLOW_TRY(parameters, ParameterBuffer::create(device, graph, plan, pointers));
  return {};
}

Result<void> Program::State::make_pipelines() {
  std::vector<std::string> names(compiled.unique.size());
  for (std::size_t i = plan.kernels.size(); i-- > 0;) names[compiled.index[i]] = plan.kernels[i].name;
  AFTERGLOW_TRY(pipelines, KernelPipelines::create(device, compiled.unique, names));
  return {};
}

/// Uniform blocks and transient images stay for good; inputs are written by `bind`.
Result<void> Program::State::make_descriptors() {
  std::vector<SetNeeds> needs;
  for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
    const CompiledKernel& kernel = compiled_of(i);
    needs.push_back({.layout = pipelines.layout(kernel).set.get(),
                     .block = {parameters.buffer(), parameters.offset(i), kernel.block_size},
                     .images = descriptor_types(kernel)});
  }
  AFTERGLOW_TRY(descriptors, Descriptors::create(device, needs));
  for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
    for (std::size_t slot = 0; slot < images[i].size(); ++slot) {
      const UnboundImage* image = arena.image(images[i][slot]);
      if (image) descriptors.write_image(i, slot, image->view(), read_layout(), sampler.get());
      if (const GpuImage* own = data.image(images[i][slot]))
        descriptors.write_image(i, slot, own->view(), data.layout(), sampler.get());
    }
  }
  return {};
}

/// What each kernel draws.
Result<void> Program::State::find_parts() {
  const auto whole = [this](ImageId id) {
    return Rect{0, 0, graph.images[id].size.width, graph.images[id].size.height};
  };
  if (options.region) {
    const Rect &part = *options.region, all = whole(graph.result);
    if (part.width < 1 || part.height < 1 || part.x < 0 || part.y < 0 || part.x + part.width > all.width ||
        part.y + part.height > all.height)
      return Error{ErrorKind::other, "the region is not within the picture"};
    parts = regions(graph, plan, part, options.rows);
    return {};
  }
  for (const auto& kernel : plan.kernels) parts.kernels.push_back(whole(kernel.output));
  for (std::size_t i = 0; i < graph.images.size(); ++i) parts.images.push_back(whole(static_cast<ImageId>(i)));
  return {};
}

/// The image that barriers name for this one, or null.
VkImage Program::State::barrier_image(ImageId id) const {
  const UnboundImage* image = linear ? nullptr : arena.image(id);
  return image ? image->get() : VkImage{VK_NULL_HANDLE};
}

/// Targets, sizes and barriers: fixed for the life of the program.
void Program::State::make_commands() {
  auto barriers = kernel_barriers(
      plan, images, [this](ImageId id) { return barrier_image(id); }, read_layout());
  for (const VkImage image : arena.linear_images()) begin.images.push_back(into_general(image));
  for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
    const ImageId output = plan.kernels[i].output;
    const UnboundImage* target = arena.image(output);
    const RowTargets* by_rows = arena.row_targets(output);
    std::vector<VkImageView> targets;
    if (by_rows)
      targets = by_rows->views();
    else if (target)
      targets = {target->view()};
    barriers[i].memory = linear && i > 0;
    kernels.push_back({.name = plan.kernels[i].name,
                       .pipeline = pipelines.pipeline(compiled.index[i]),
                       .layout = pipelines.layout(compiled_of(i)).pipeline.get(),
                       .set = descriptors.set(i),
                       .targets = std::move(targets),
                       .rows = compiled_of(i).rows,
                       .target_size = graph.images[output].size,
                       .first_image_size = images[i].empty() ? Size{} : graph.images[images[i].front()].size,
                       .part = parts.kernels[i],
                       .target_layout = target_layout(output),
                       .barriers = std::move(barriers[i])});
  }
}

/// Some kernels: images that the others have made are in the layout for reading already and stay so.
void Program::State::record_some(VkCommandBuffer commands, const std::vector<bool>& run,
                                 const std::function<void(std::size_t)>& stamp) const {
  Plan some;
  std::vector<std::vector<ImageId>> read;
  std::set<ImageId> made;
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    if (!run[i]) continue;
    some.kernels.push_back(plan.kernels[i]);
    read.push_back(images[i]);
    made.insert(plan.kernels[i].output);
  }
  const auto image_of = [&](ImageId id) { return made.contains(id) ? barrier_image(id) : VkImage{VK_NULL_HANDLE}; };
  auto barriers = kernel_barriers(some, read, image_of, read_layout());
  for (std::size_t i = 0, next = 0; i < kernels.size(); ++i) {
    if (run[i]) {
      KernelCommands kernel = kernels[i];
      kernel.barriers = std::move(barriers[next++]);
      kernel.barriers.memory = linear;
      record_kernel(device, commands, kernel, result);
    }
    stamp(i + 1);
  }
}

Program::Program(std::unique_ptr<State> state) : state_(std::move(state)) {}
Program::~Program() = default;

Result<std::unique_ptr<Program>> Program::create(Device& device, ShaderLibrary& shaders, KernelCompiler& compiler,
                                                 const Graph& graph, const ProgramOptions& options) {
  AFTERGLOW_CHECK(validate(graph));
  auto state = std::make_unique<State>(device, graph, options);
  const bool half = options.storage == Storage::fp16;
  state->format = half ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
  state->plan = make_plan(graph, {.joining = options.reference ? Joining::none : options.joining});
  state->storage_reads = options.storage_reads && can(device, state->format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT);
  static std::atomic<std::uint64_t> programs = 0;
  state->id = ++programs;
  state->changed.assign(state->plan.kernels.size(), true);
  AFTERGLOW_CHECK(state->find_parts());
  AFTERGLOW_CHECK(state->check());
  if (!state->plan.kernels.empty()) {
    AFTERGLOW_TRY(std::vector<KernelDesc> descs, state->describe(shaders));
    AFTERGLOW_CHECK(state->make_images(descs));
    AFTERGLOW_CHECK(state->compile(compiler, descs));
    AFTERGLOW_CHECK(state->make_pipelines());
    AFTERGLOW_CHECK(state->make_descriptors());
    state->make_commands();
  }
  return std::unique_ptr<Program>(new Program(std::move(state)));
}

void Program::set_parameters(const Graph& graph) {
  if (same_structure(state_->graph, graph)) state_->parameters.write(graph, state_->changed);
}

std::vector<bool> Program::kernels_to_run(const std::vector<ImageId>& changed_inputs, bool result_lost) const {
  const State& s = *state_;
  std::vector<bool> changed = s.changed;
  if (result_lost)
    for (std::size_t i = 0; i < changed.size(); ++i)
      if (s.plan.kernels[i].output == s.graph.result) changed[i] = true;
  std::vector<bool> run = afterglow::kernels_to_run(s.graph, s.plan, changed, changed_inputs);
  const bool any = std::ranges::find(run, true) != run.end();
  if (any && !s.options.keep_images) run.assign(run.size(), true);
  return run;
}

void Program::up_to_date() { state_->changed.assign(state_->changed.size(), false); }
std::uint64_t Program::id() const { return state_->id; }
const Regions& Program::parts() const { return state_->parts; }

Result<void> Program::bind(const std::map<std::string, ImageBinding>& inputs, const ImageBinding& result) {
  State& s = *state_;
  if (s.kernels.empty()) return {};
  const auto fail = [](const std::string& message) { return Error{ErrorKind::other, message}; };
  const Size size = s.graph.images[s.graph.result].size;
  if (result.view == VK_NULL_HANDLE || result.format != s.result_format() || result.size != size) {
    return fail(
        fmt::format("the result must be an image of {}×{} pixels in the result's format", size.width, size.height));
  }
  if (s.result_rows > 1 && result.rows.size() != static_cast<std::size_t>(s.result_rows))
    return fail(fmt::format("the result must have targets by {} rows", s.result_rows));
  std::map<ImageId, VkImageView> views;
  const auto add = [&](const std::string& name, ImageId id) -> Result<void> {
    const auto found = inputs.find(name);
    const Size wanted = s.graph.images[id].size;
    if (found == inputs.end() || found->second.view == VK_NULL_HANDLE)
      return fail(fmt::format("no image is bound to '{}'", name));
    if (found->second.size != wanted) {
      return fail(fmt::format("the image bound to '{}' has {}×{} pixels, not {}×{}", name, found->second.size.width,
                              found->second.size.height, wanted.width, wanted.height));
    }
    views[id] = found->second.view;
    return {};
  };
  AFTERGLOW_CHECK(add("source", s.graph.source));
  for (const auto& [name, id] : s.graph.auxiliary) AFTERGLOW_CHECK(add(name, id));
  for (std::size_t i = 0; i < s.kernels.size(); ++i) {
    for (std::size_t slot = 0; slot < s.images[i].size(); ++slot) {
      const ImageId id = s.images[i][slot];
      const VkImageLayout layout = id == s.graph.source ? s.source_layout() : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
      if (const auto view = views.find(id); view != views.end())
        s.descriptors.write_image(i, slot, view->second, layout, s.sampler.get());
    }
  }
  s.result = s.result_rows > 1 ? result.rows : std::vector{result.view};
  ++s.bindings;
  return {};
}

void Program::record(VkCommandBuffer commands, int only, VkQueryPool timestamps, const std::vector<bool>& run) const {
  const State& s = *state_;
  if (s.bindings == 0) return;
  if (only >= 0) {
    if (static_cast<std::size_t>(only) < s.kernels.size()) record_kernel(s.device, commands, s.kernels[only], s.result);
    return;
  }
  const auto stamp = [&](std::size_t query) {
    if (timestamps == VK_NULL_HANDLE) return;
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, timestamps, static_cast<std::uint32_t>(query));
  };
  if (timestamps != VK_NULL_HANDLE) {
    vkCmdResetQueryPool(commands, timestamps, 0, static_cast<std::uint32_t>(s.kernels.size() + 1));
  }
  stamp(0);
  if (std::ranges::find(run, false) != run.end()) {
    s.record_some(commands, run, stamp);
    return;
  }
  record_barriers(commands, s.begin);
  for (std::size_t i = 0; i < s.kernels.size(); ++i) {
    record_kernel(s.device, commands, s.kernels[i], s.result);
    stamp(i + 1);
  }
}

const Plan& Program::plan() const { return state_->plan; }
const Graph& Program::graph() const { return state_->graph; }
ProgramMemory Program::memory() const { return state_->arena.memory(); }
int Program::bindings() const { return state_->bindings; }
VkFormat Program::storage_format() const { return state_->format; }
VkFormat Program::result_format() const { return state_->result_format(); }
int Program::result_rows() const { return state_->result_rows; }
VkImageLayout Program::source_layout() const { return state_->source_layout(); }

std::optional<Program::Transient> Program::transient(ImageId image) const {
  const UnboundImage* found = state_->arena.image(image);
  if (!found) return std::nullopt;
  return Transient{{found->get(), found->view(), found->desc().format, found->desc().size},
                   state_->read_layout(),
                   state_->options.reference};
}

Program::Counters Program::counters() const {
  const State& s = *state_;
  return {.pipelines = s.pipelines.size(),
          .images = s.arena.images() + s.data.size(),
          .allocations = s.arena.allocations() + (s.parameters.buffer() != VK_NULL_HANDLE ? 1 : 0)};
}

}  // namespace afterglow
