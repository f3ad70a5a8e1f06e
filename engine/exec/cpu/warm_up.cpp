// SPDX-License-Identifier: MIT
#include "exec/cpu/warm_up.h"

#include <cstdlib>
#include <string_view>

#include "exec/frame_inputs.h"
#include "exec/frame_result.h"
#include "exec/histories.h"
#include "exec/host_input.h"
#include "exec/pipeline_pool.h"
#include "exec/submit.h"

namespace afterglow {
namespace {

/// Mesa's ways of turning its cache off.
bool cache_is_off() {
  for (const char* name : {"MESA_SHADER_CACHE_DISABLE", "MESA_GLSL_CACHE_DISABLE"}) {
    const char* value = std::getenv(name);
    if (!value) continue;
    const std::string_view text = value;
    if (text == "1" || text == "true" || text == "yes" || text == "y") return true;
  }
  return false;
}

}  // namespace

struct WarmUp::State {
  State(std::unique_ptr<Device> device_in)
      : device(std::move(device_in)), inputs(*device, true), result(*device, true) {}

  std::unique_ptr<Device> device;
  PipelinePool pipelines;
  std::unique_ptr<Program> last;  ///< keeps its pipelines, with which the driver keeps what it has compiled
  FrameInputs inputs;
  FrameResult result;
  Submitter submitter;  // last: it waits before the images go
};

WarmUp::WarmUp(std::unique_ptr<State> state) : state_(std::move(state)) {}
WarmUp::~WarmUp() = default;

bool WarmUp::helps(const Device& device) { return device.is_cpu() && !cache_is_off(); }

Result<std::unique_ptr<WarmUp>> WarmUp::create(const Device& device, bool validate) {
  Diagnostics nowhere;
  AFTERGLOW_TRY(
      auto own,
      Device::create({.device = device.info().uuid, .validate = validate, .forced = device.forced()}, nowhere));
  auto state = std::make_unique<State>(std::move(own));
  AFTERGLOW_TRY(state->submitter, Submitter::create(*state->device));
  return std::unique_ptr<WarmUp>(new WarmUp(std::move(state)));
}

Result<void> WarmUp::draw(ShaderLibrary& shaders, KernelCompiler& compiler, const Graph& graph,
                          ProgramOptions options) {
  State& s = *state_;
  options.region.reset();
  options.keep_images = false;
  options.pipelines = &s.pipelines;
  options.images = nullptr;
  options.histories = nullptr;
  AFTERGLOW_TRY(auto program, Program::create(*s.device, shaders, compiler, graph, options));
  if (program->plan().kernels.empty()) return {};
  AFTERGLOW_TRY(const auto wanted, FrameInputs::wanted_by(*program, usual_inputs(graph)));
  AFTERGLOW_CHECK(s.submitter.wait());
  AFTERGLOW_CHECK(s.inputs.prepare(wanted));
  AFTERGLOW_CHECK(s.result.take(FrameResult::wanted_by(*program), program->result_rows()));
  if (program->histories()) program->histories()->begin(0);
  AFTERGLOW_CHECK(program->bind(s.inputs.bindings(), binding_of(s.result.image())));
  AFTERGLOW_CHECK(s.submitter.submit([&](VkCommandBuffer commands) {
    s.inputs.before(*program, commands);
    s.result.before(commands);
    program->record_a_pixel_each(commands, true);
    s.inputs.after(commands);
    s.result.after(commands);
  }));
  AFTERGLOW_CHECK(s.submitter.wait());
  s.last = std::move(program);
  return {};
}

int WarmUp::validation_errors() const { return state_->device->validation_errors(); }

}  // namespace afterglow
