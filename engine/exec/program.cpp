// SPDX-License-Identifier: MIT
#include "exec/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "exec/describe.h"
#include "exec/program_state.h"
#include "graph/history.h"

namespace afterglow {

Program::Program(std::unique_ptr<State> state) : state_(std::move(state)) {}
Program::~Program() {
  const Device& device = state_->device;
  state_.reset();
  device.free_destroyed();
}

Result<std::unique_ptr<Program>> Program::create(Device& device, ShaderLibrary& shaders, KernelCompiler& compiler,
                                                 const Graph& graph, const ProgramOptions& options) {
  AFTERGLOW_CHECK(validate(graph));
  auto state = std::make_unique<State>(device, graph, options);
  state->settle_config();
  state->settle_workgroups(shaders);
  state->plan = make_plan(graph, state->options.config, state->may_store_result());
  static std::atomic<std::uint64_t> programs = 0;
  state->serial = ++programs;
  state->made.resize(state->plan.kernels.size());
  AFTERGLOW_CHECK(state->check());
  if (state->plan.kernels.empty()) {
    AFTERGLOW_CHECK(state->find_parts());
  } else {
    AFTERGLOW_TRY(std::vector<KernelDesc> descs, state->describe(shaders));
    const auto compiled = state->settle_and_compile(compiler, descs);
    if (!compiled && !may_compile_apart(compiled.error(), options.config)) return compiled.error();
    if (!compiled || state->share_too_much()) {
      ProgramOptions other = options;
      if (compiled)
        other.config.compute = false;
      else
        other.config.fusion = Fusion::filters;
      state.reset();
      return create(device, shaders, compiler, graph, other);
    }
    AFTERGLOW_CHECK(state->find_parts());
    state->identify();
    AFTERGLOW_CHECK(state->take_images(descs));
    AFTERGLOW_CHECK(state->make_pipelines());
    AFTERGLOW_CHECK(state->make_marks());
    AFTERGLOW_CHECK(state->make_histories());
    AFTERGLOW_CHECK(state->make_place());
    if (state->histories) AFTERGLOW_CHECK(state->use(state->histories));
    if (!state->histories) state->make_commands();
  }
  return std::unique_ptr<Program>(new Program(std::move(state)));
}

Result<void> Program::set_parameters(const Graph& graph) {
  if (!same_structure(state_->graph, graph)) return {};
  AFTERGLOW_CHECK(state_->parameters.write(graph));
  state_->graph.histories = graph.histories;  // values of first frames
  state_->bring_along(graph);
  return {};
}

/// Pixels that the device does not have yet are brought to it when the program is bound again.
void Program::State::bring_along(const Graph& given) {
  bool changed = false;
  for (std::size_t i = 0; i < graph.images.size(); ++i) {
    auto& own = graph.images[i].data;
    const auto& next = given.images[i].data;
    changed = changed || (own && own->hash != next->hash);
    own = next;
  }
  if (!changed) return;
  for (Place& place : places) {
    place.bound = false;
    ++place.bindings;
  }
}

bool Program::has_previous(const std::string& history) const {
  return state_->histories && state_->histories->has_previous(history);
}
Histories* Program::histories() const { return state_->histories.get(); }
Result<void> Program::use(std::shared_ptr<Histories> histories) { return state_->use(std::move(histories)); }
int Program::recording() const { return state_->begins_anew() ? kUnlikeOthers : state_->parity(); }
std::uint64_t Program::id() const { return state_->serial; }
const Regions& Program::parts() const { return state_->parts; }

Result<void> Program::bind(const std::map<std::string, ImageBinding>& inputs, const ImageBinding& result, int place) {
  State& s = *state_;
  if (s.plan.kernels.empty()) return {};
  const auto fail = [](const std::string& message) { return Error{ErrorKind::other, message}; };
  const Size size = s.graph.images[s.graph.result].size;
  if (result.view == VK_NULL_HANDLE || result.format != s.result_format() || result.size != size) {
    return fail(
        fmt::format("the result must be an image of {}×{} pixels in the result's format", size.width, size.height));
  }
  if (s.result_rows > 1 && result.rows.size() != static_cast<std::size_t>(s.result_rows))
    return fail(fmt::format("the result must have targets by {} rows", s.result_rows));
  std::map<ImageId, ImageBinding> bound;
  const auto add = [&](const std::string& name, ImageId id) -> Result<void> {
    const auto found = inputs.find(name);
    const Size wanted = s.graph.images[id].size;
    if (found == inputs.end() || found->second.view == VK_NULL_HANDLE)
      return fail(fmt::format("no image is bound to '{}'", name));
    if (found->second.size != wanted) {
      return fail(fmt::format("the image bound to '{}' has {}×{} pixels, not {}×{}", name, found->second.size.width,
                              found->second.size.height, wanted.width, wanted.height));
    }
    bound[id] = found->second;
    return {};
  };
  AFTERGLOW_CHECK(add("source", s.graph.source));
  for (const auto& [name, id] : s.graph.auxiliary) AFTERGLOW_CHECK(add(name, id));
  // Images of hosts have formats of their own.
  for (std::size_t kernel = 0; kernel < s.images.size(); ++kernel)
    for (std::size_t slot = 0; slot < s.images[kernel].size(); ++slot) {
      const auto found = bound.find(s.images[kernel][slot]);
      if (found != bound.end() && s.interpolates(kernel, slot) &&
          !supports(s.device, found->second.format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT))
        return fail(
            fmt::format("'{}' has a format between whose pixels this device cannot interpolate, as {} does with "
                        "this allowed error",
                        s.graph.images[found->first].name, s.plan.kernels[kernel].name));
    }
  AFTERGLOW_CHECK(s.data.fill(s.device, s.graph));
  while (s.places.size() <= static_cast<std::size_t>(place)) AFTERGLOW_CHECK(s.make_place());
  State::Place& at = s.places[static_cast<std::size_t>(place)];
  at.inputs = std::move(bound);
  at.result = s.result_rows > 1 ? result.rows : std::vector{result.view};
  const auto look = [&](ImageId id) {
    return s.stores_result() && id == s.graph.result ? State::Seen{result.view, VK_IMAGE_LAYOUT_GENERAL}
                                                     : s.look_at_input(at, id);
  };
  for (int which = 0; which < s.sets(); ++which) s.write_set(at, which, look);
  at.bound = true;
  ++at.bindings;
  return {};
}

void Program::record(VkCommandBuffer commands, VkQueryPool timestamps, const std::vector<bool>& run, int place) const {
  const State& s = *state_;
  if (!bound(place)) return;
  const State::Place& at = s.places[static_cast<std::size_t>(place)];
  const std::size_t count = s.plan.kernels.size();
  const auto stamp = [&](std::size_t query) {
    if (timestamps == VK_NULL_HANDLE) return;
    s.device.vk().vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, timestamps,
                                       static_cast<std::uint32_t>(query));
  };
  if (timestamps != VK_NULL_HANDLE) {
    s.device.vk().vkCmdResetQueryPool(commands, timestamps, 0, static_cast<std::uint32_t>(count + 1));
  }
  stamp(0);
  s.begin_recording(commands, at);
  if (std::ranges::find(run, false) != run.end())
    s.record_some(commands, at, run, stamp);
  else
    s.record_all(commands, at, stamp);
  s.loops.record(s.device, commands);
}

const Plan& Program::plan() const { return state_->plan; }
const Graph& Program::graph() const { return state_->graph; }
ProgramMemory Program::memory() const {
  ProgramMemory memory = state_->arena.memory();
  if (state_->histories) memory.histories = state_->histories->bytes();
  return memory;
}
std::vector<std::string> Program::warnings() const {
  std::vector<std::string> all;
  for (const auto& kernel : state_->compiled.unique)
    for (const auto& warning : kernel.warnings)
      if (std::ranges::find(all, warning) == all.end()) all.push_back(warning);
  return all;
}
bool Program::bound(int place) const {
  const auto at = static_cast<std::size_t>(place);
  return at < state_->places.size() && state_->places[at].bound;
}
int Program::bindings(int place) const {
  return (bound(place) ? state_->places[static_cast<std::size_t>(place)].bindings : 0) + state_->uses;
}
VkFormat Program::storage_format() const { return state_->format; }
const ExecutionConfig& Program::config() const { return state_->options.config; }
bool Program::flags_non_finite() const { return state_->options.flag_non_finite; }
VkFormat Program::result_format() const { return state_->result_format(); }
int Program::result_rows() const { return state_->result_rows; }
bool Program::stores_result() const { return state_->stores_result(); }
VkImageLayout Program::input_layout() const { return state_->input_layout(); }

std::optional<Program::Transient> Program::transient(ImageId image) const {
  const State& s = *state_;
  const auto seen = [](const auto& found) {
    return ImageBinding{found.get(), found.view(), found.desc().format, found.desc().size};
  };
  if (const GpuImage* history = s.history_image(image, s.parity()))
    return Transient{seen(*history), s.history_layout(), true};
  const UnboundImage* found = s.arena.image(image);
  if (!found) return std::nullopt;
  return Transient{seen(*found), s.read_layout(), s.options.reference};
}

Program::Counters Program::counters() const {
  const State& s = *state_;
  return {.pipelines = s.pipelines.size(),
          .images = s.arena.images() + s.data.size() + (s.marks ? 1 : 0),
          .allocations = s.arena.allocations() + (s.marks ? 1 : 0) + (s.parameters.buffer() != VK_NULL_HANDLE ? 1 : 0)};
}

}  // namespace afterglow
