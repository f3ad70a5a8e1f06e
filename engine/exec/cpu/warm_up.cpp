// SPDX-License-Identifier: MIT
#include "exec/cpu/warm_up.h"

#include <cstdlib>
#include <limits>
#include <string_view>

#include "exec/frame_runner.h"
#include "exec/histories.h"
#include "exec/pipeline_pool.h"

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
  std::unique_ptr<Device> device;
  PipelinePool pipelines;
  std::unique_ptr<Program> last;  ///< keeps its pipelines, with which the driver keeps what it has compiled
  std::unique_ptr<FrameRunner> runner;
};

WarmUp::WarmUp(std::unique_ptr<State> state) : state_(std::move(state)) {}
WarmUp::~WarmUp() = default;

bool WarmUp::helps(const Device& device) { return device.is_cpu() && !cache_is_off(); }

Result<std::unique_ptr<WarmUp>> WarmUp::create(const Device& device, bool validate) {
  Diagnostics nowhere;
  AFTERGLOW_TRY(
      auto own,
      Device::create({.device = device.info().uuid, .validate = validate, .forced = device.forced()}, nowhere));
  auto state = std::make_unique<State>();
  state->device = std::move(own);
  constexpr FrameRunner::Options kNoLimit{.max_memory = std::numeric_limits<std::uint64_t>::max()};
  AFTERGLOW_TRY(state->runner, FrameRunner::create(*state->device, kNoLimit));
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
  if (program->histories()) program->histories()->begin(0);
  AFTERGLOW_CHECK(s.runner->warm_up(*program, true));
  AFTERGLOW_CHECK(s.runner->wait());
  s.last = std::move(program);
  return {};
}

int WarmUp::validation_errors() const { return state_->device->validation_errors(); }

}  // namespace afterglow
