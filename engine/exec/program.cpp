#include "exec/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "exec/arena.h"
#include "exec/barriers.h"
#include "exec/describe.h"
#include "exec/parallel.h"
#include "exec/parameters.h"
#include "exec/record.h"
#include "gpu/error.h"
#include "gpu/fullscreen_vertex.h"
#include "gpu/pipeline.h"

namespace afterglow {

struct Program::State {
  State(Device& device_in, const Graph& graph_in, const ProgramOptions& options_in)
      : device(device_in), graph(graph_in), options(options_in) {}

  Device& device;
  Graph graph;
  ProgramOptions options;
  VkFormat format = VK_FORMAT_UNDEFINED;
  Plan plan;

  CompiledKernels compiled;
  std::vector<std::vector<ImageId>> images;  ///< to bind, parallel to the plan's kernels
  ParameterBuffer parameters;
  Arena arena;
  std::map<DrawInterface, DrawLayout> layouts;
  std::vector<PipelineHandle> pipelines;  ///< parallel to compiled.unique
  SamplerHandle sampler;
  DescriptorPoolHandle pool;
  std::vector<KernelCommands> kernels;
  VkImageView result = VK_NULL_HANDLE;
  bool storage_reads = false;
  bool bound = false;

  VkImageLayout read_layout() const {
    return storage_reads ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  }
  VkImageLayout source_layout() const {
    return options.source_is_storage ? read_layout() : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  }

  const CompiledKernel& compiled_of(std::size_t kernel) const { return compiled.unique[compiled.index[kernel]]; }
  Result<void> check();
  Result<void> compile(ShaderLibrary& shaders, KernelCompiler& compiler);
  Result<void> make_pipelines();
  Result<void> make_descriptors();
  void make_commands();
  void write_image(std::size_t kernel, std::size_t slot, VkImageView view) const;
};

namespace {

VkDescriptorType descriptor_type(ImageRead read) {
  return read == ImageRead::sampled ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
}

DrawInterface interface_of(const CompiledKernel& compiled) {
  DrawInterface out{.block = compiled.block_size > 0, .images = {}, .push_bytes = kPushConstantBytes};
  for (const auto& image : compiled.images) out.images.push_back(descriptor_type(image.read));
  return out;
}

bool can(const Device& device, VkFormat format, VkFormatFeatureFlags wanted) {
  VkFormatProperties properties{};
  vkGetPhysicalDeviceFormatProperties(device.physical(), format, &properties);
  return (properties.optimalTilingFeatures & wanted) == wanted;
}

}  // namespace

/// What the device must be able to do, before anything is made.
Result<void> Program::State::check() {
  if (graph.result != graph.source && graph.images[graph.result].producer < 0) {
    return Error{ErrorKind::other, fmt::format("the result '{}' is an input", graph.images[graph.result].name)};
  }
  for (const auto& kernel : plan.kernels) {
    const GraphImage& image = graph.images[kernel.output];
    AFTERGLOW_CHECK(check_image(device, {.name = image.name,
                                         .size = image.size,
                                         .format = format,
                                         .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT}));
  }
  return {};
}

Result<void> Program::State::compile(ShaderLibrary& shaders, KernelCompiler& compiler) {
  const DescribeOptions describe{
      .hardware_filter = options.hardware_filter && !options.reference &&
                         can(device, format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT),
      .half_storage = options.storage == Storage::fp16,
      .storage_reads = storage_reads,
      .source_is_storage = options.source_is_storage};
  std::vector<KernelDesc> descs;
  for (const auto& kernel : plan.kernels) {
    AFTERGLOW_TRY(KernelDesc desc, describe_kernel(shaders, graph, kernel, describe));
    descs.push_back(std::move(desc));
  }
  AFTERGLOW_TRY(compiled, compile_kernels(compiler, descs));
  std::vector<const CompiledKernel*> pointers;
  for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
    AFTERGLOW_TRY(std::vector<ImageId> bind, images_of_slots(graph, plan.kernels[i], compiled_of(i)));
    images.push_back(std::move(bind));
    pointers.push_back(&compiled_of(i));
  }
  AFTERGLOW_TRY(sampler, create_sampler(device, describe.hardware_filter ? VK_FILTER_LINEAR : VK_FILTER_NEAREST));
  AFTERGLOW_TRY(parameters, ParameterBuffer::create(device, graph, plan, pointers));
  return {};
}

Result<void> Program::State::make_pipelines() {
  for (const auto& kernel : compiled.unique) {
    const DrawInterface interface = interface_of(kernel);
    if (layouts.contains(interface)) continue;
    AFTERGLOW_TRY(DrawLayout layout, create_draw_layout(device, interface));
    layouts.emplace(interface, std::move(layout));
  }
  std::vector<std::string> names(compiled.unique.size());
  for (std::size_t i = plan.kernels.size(); i-- > 0;) names[compiled.index[i]] = plan.kernels[i].name;
  AFTERGLOW_TRY(const ShaderModuleHandle vertex,
                create_shader_module(device, kFullscreenVertex, "full-screen triangle"));
  std::vector<std::optional<Result<PipelineHandle>>> made(compiled.unique.size());
  parallel_for(made.size(), [&](std::size_t i) {
    const CompiledKernel& kernel = compiled.unique[i];
    auto fragment = create_shader_module(device, kernel.spirv, names[i]);
    if (!fragment) {
      made[i].emplace(std::move(fragment).error());
      return;
    }
    made[i].emplace(create_draw_pipeline(device, layouts.at(interface_of(kernel)), vertex.get(), fragment->get(),
                                         format, names[i]));
  });
  for (auto& result_or_error : made) {
    if (!*result_or_error) return std::move(*result_or_error).error();
    pipelines.push_back(std::move(*result_or_error).value());
  }
  return {};
}

/// One set a kernel. Uniform blocks and transient images stay for good; inputs are written by `bind`.
Result<void> Program::State::make_descriptors() {
  std::uint32_t blocks = 0, samplers = 0, storage = 0;
  for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
    blocks += compiled_of(i).block_size > 0;
    for (const auto& image : compiled_of(i).images) ++(image.read == ImageRead::sampled ? samplers : storage);
  }
  std::vector<VkDescriptorPoolSize> sizes;
  if (blocks > 0) sizes.push_back({VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, blocks});
  if (samplers > 0) sizes.push_back({VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, samplers});
  if (storage > 0) sizes.push_back({VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, storage});
  const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                        .maxSets = static_cast<std::uint32_t>(plan.kernels.size()),
                                        .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
                                        .pPoolSizes = sizes.data()};
  VkDescriptorPool handle = VK_NULL_HANDLE;
  AFTERGLOW_VK(vkCreateDescriptorPool(device.handle(), &info, nullptr, &handle), "cannot create a descriptor pool");
  pool = DescriptorPoolHandle(device.handle(), handle);

  for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
    const DrawLayout& layout = layouts.at(interface_of(compiled_of(i)));
    const VkDescriptorSetLayout set_layout = layout.set.get();
    const VkDescriptorSetAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                               .descriptorPool = handle,
                                               .descriptorSetCount = 1,
                                               .pSetLayouts = &set_layout};
    KernelCommands kernel{.name = plan.kernels[i].name, .layout = layout.pipeline.get()};
    AFTERGLOW_VK(vkAllocateDescriptorSets(device.handle(), &allocate, &kernel.set), "cannot allocate descriptors");
    if (compiled_of(i).block_size > 0) {
      const VkDescriptorBufferInfo block{parameters.buffer(), parameters.offset(i), compiled_of(i).block_size};
      const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                       .dstSet = kernel.set,
                                       .dstBinding = 0,
                                       .descriptorCount = 1,
                                       .descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                                       .pBufferInfo = &block};
      vkUpdateDescriptorSets(device.handle(), 1, &write, 0, nullptr);
    }
    kernels.push_back(std::move(kernel));
    for (std::size_t slot = 0; slot < images[i].size(); ++slot) {
      if (const UnboundImage* image = arena.image(images[i][slot])) write_image(i, slot, image->view());
    }
  }
  return {};
}

void Program::State::write_image(std::size_t kernel, std::size_t slot, VkImageView view) const {
  const ImageId id = images[kernel][slot];
  const ImageRead read = compiled_of(kernel).images[slot].read;
  const VkImageLayout layout = arena.image(id)      ? read_layout()
                               : id == graph.source ? source_layout()
                                                    : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  const VkDescriptorImageInfo image{read == ImageRead::sampled ? sampler.get() : VkSampler{VK_NULL_HANDLE}, view, layout};
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = kernels[kernel].set,
                                   .dstBinding = static_cast<std::uint32_t>(slot) + 1,
                                   .descriptorCount = 1,
                                   .descriptorType = descriptor_type(read),
                                   .pImageInfo = &image};
  vkUpdateDescriptorSets(device.handle(), 1, &write, 0, nullptr);
}

/// Targets, sizes and barriers: fixed for the life of the program.
void Program::State::make_commands() {
  auto barriers = kernel_barriers(plan, images, [this](ImageId id) {
    const UnboundImage* image = arena.image(id);
    return image ? image->get() : VkImage{VK_NULL_HANDLE};
  }, read_layout());
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    KernelCommands& kernel = kernels[i];
    kernel.pipeline = pipelines[compiled.index[i]].get();
    kernel.target_size = graph.images[plan.kernels[i].output].size;
    kernel.first_image_size = images[i].empty() ? Size{} : graph.images[images[i].front()].size;
    kernel.barriers = std::move(barriers[i]);
    if (const UnboundImage* target = arena.image(plan.kernels[i].output)) kernel.target = target->view();
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
  state->plan = make_plan(graph, {.join = !options.reference,
                                  .alias = options.share_memory && !options.reference,
                                  .bytes_per_pixel = half ? 8u : 16u});
  state->storage_reads = options.storage_reads && can(device, state->format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT);
  AFTERGLOW_CHECK(state->check());
  if (!state->plan.kernels.empty()) {
    AFTERGLOW_TRY(state->arena, Arena::create(device, graph, state->plan,
                                              {.format = state->format,
                                               .share = options.share_memory && !options.reference,
                                               .readable = options.reference,
                                               .storage = state->storage_reads,
                                               .max_memory = options.max_memory}));
    AFTERGLOW_CHECK(state->compile(shaders, compiler));
    AFTERGLOW_CHECK(state->make_pipelines());
    AFTERGLOW_CHECK(state->make_descriptors());
    state->make_commands();
  }
  return std::unique_ptr<Program>(new Program(std::move(state)));
}

void Program::set_parameters(const Graph& graph) { state_->parameters.write(graph); }

Result<void> Program::bind(const std::map<std::string, ImageBinding>& inputs, const ImageBinding& result) {
  State& s = *state_;
  if (s.kernels.empty()) return {};
  const auto fail = [](const std::string& message) { return Error{ErrorKind::other, message}; };
  const Size size = s.graph.images[s.graph.result].size;
  if (result.view == VK_NULL_HANDLE || result.format != s.format || result.size != size) {
    return fail(
        fmt::format("the result must be an image of {}×{} pixels in the storage format", size.width, size.height));
  }
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
      if (const auto view = views.find(s.images[i][slot]); view != views.end())
        s.write_image(i, slot, view->second);
    }
  }
  s.result = result.view;
  s.bound = true;
  return {};
}

void Program::record(VkCommandBuffer commands, int only, VkQueryPool timestamps) const {
  const State& s = *state_;
  if (!s.bound) return;
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
  for (std::size_t i = 0; i < s.kernels.size(); ++i) {
    record_kernel(s.device, commands, s.kernels[i], s.result);
    stamp(i + 1);
  }
}

const Plan& Program::plan() const { return state_->plan; }
const Graph& Program::graph() const { return state_->graph; }
ProgramMemory Program::memory() const { return state_->arena.memory(); }
VkFormat Program::storage_format() const { return state_->format; }
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
  return {.pipelines = static_cast<int>(s.pipelines.size()),
          .images = s.arena.images(),
          .allocations = s.arena.allocations() + (s.parameters.buffer() != VK_NULL_HANDLE ? 1 : 0)};
}

}  // namespace afterglow
