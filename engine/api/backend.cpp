// SPDX-License-Identifier: MIT
#include "api/backend.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/cache_folder.h"
#include "graph/history.h"

namespace afterglow::api {

Result<void> SharedDevice::open(const DeviceOptions& options, const std::filesystem::path& cache_folder) {
  AFTERGLOW_TRY(device, Device::create(options, diagnostics));
  share(cache_folder);
  return {};
}

Result<void> SharedDevice::adopt(const AdoptedDevice& adopted, const std::filesystem::path& cache_folder) {
  AFTERGLOW_TRY(device, Device::adopt(adopted, diagnostics));
  share(cache_folder);
  return {};
}

Result<void> SharedDevice::check_process() const {
  if (is_of_this_process()) return {};
  return Error{ErrorKind::device, "the device was opened before fork(): open it in this process"};
}

void SharedDevice::share(const std::filesystem::path& cache_folder) {
  if (!cache_folder.empty())
    if (const auto made = make_cache_folder(cache_folder / "shaders"); !made)
      diagnostics.warn(made.error().file + ": " + made.error().message + "; nothing new is kept");
  shared = std::make_shared<SharedKernels>(cache_folder.empty() ? cache_folder : cache_folder / "shaders");
  if (!cache_folder.empty()) device->use_pipeline_cache((cache_folder / "pipelines").string());
}

Backend::Backend(std::shared_ptr<SharedDevice> device, const BackendOptions& options)
    : device_(std::move(device)),
      options_(options),
      diagnostics_(options.message),
      given_{options.stack.preset.overrides, options.stack.preset.arguments} {}
Backend::~Backend() = default;

Result<std::unique_ptr<Backend>> Backend::open(std::shared_ptr<SharedDevice> device, const BackendOptions& options) {
  std::unique_ptr<Backend> out(new Backend(std::move(device), options));
  out->options_.stack.shared = out->device_->shared;
  const auto make = options.follow ? follow_source : load_source;
  AFTERGLOW_TRY(out->source_, make(*out->device_, out->options_, out->diagnostics_));
  if (!options.commands) {
    AFTERGLOW_TRY(out->renderer_, Renderer::create(*out->device_->device, {.max_memory = options.stack.max_memory}));
  }
  return out;
}

/// Calls forget_what_went at the end of a block, by an exception too.
class Backend::Forgetting {
 public:
  explicit Forgetting(Backend& backend) : backend_(&backend), before_(&backend.source_->stack()) {}
  Forgetting(const Forgetting&) = delete;
  ~Forgetting() {
    if (backend_) backend_->forget_what_went(before_);
  }
  void dismiss() { backend_ = nullptr; }

 private:
  Backend* backend_;
  const Stack* before_;
};

Result<void> Backend::set(const std::vector<Override>& several) {
  Given all = given_;
  std::erase_if(all.overrides, [&](const Override& before) {
    return std::ranges::any_of(
        several, [&](const Override& now) { return now.entry == before.entry && now.setting == before.setting; });
  });
  all.overrides.insert(all.overrides.end(), several.begin(), several.end());
  return set_all(std::move(all), {.overrides = several.size()});
}

Result<void> Backend::unset(const std::optional<std::string>& name) {
  Given all = given_;
  if (std::erase_if(all.overrides, [&](const Override& o) { return !name || o.entry + "." + o.setting == *name; }) == 0)
    return {};
  return set_all(std::move(all), {});
}

Result<void> Backend::set_argument(const std::string& name, const std::optional<std::string>& value) {
  Given all = given_;
  const auto gone = std::erase_if(all.arguments, [&](const ArgumentValue& a) { return a.name == name; });
  if (value) all.arguments.push_back({name, *value});
  if (!value && gone == 0) return {};
  return set_all(std::move(all), {.arguments = value ? 1u : 0u});
}

Result<void> Backend::set_all(Given all, MustFit must_fit) {
  const Forgetting forgetting(*this);
  auto done = source_->set(all, must_fit);
  if (done) given_ = std::move(all);
  return done;
}

Result<bool> Backend::update() {
  const Forgetting forgetting(*this);
  return source_->update();
}

Result<void> Backend::reload(const std::optional<std::string>& text) {
  const Forgetting forgetting(*this);
  return source_->reload(text);
}

/// What was prepared goes with its stack (`before`, which may be no more) or its program; a failure alone leaves it.
void Backend::forget_what_went(const Stack* before) {
  Stack& now = source_->stack();
  if (&now == before && now.programs()->work()) return;
  prepared_ = false;
  build_.reset();
  seen_.reset();
  last_ = {};
}

/// The last frame, by what the stack says now; null before there is one.
const Build* Backend::seen() {
  if (build_) return build_.get();
  if (!seen_ && shape_) {
    auto build = source_->evaluate(*shape_);
    seen_ = build ? *std::move(build) : nullptr;
  }
  return seen_ ? seen_->get() : nullptr;
}

Result<void> Backend::prepare(const Shape& shape) {
  Forgetting forgetting(*this);
  auto done = prepare_frame(shape);
  if (done) forgetting.dismiss();
  return done;
}

Result<std::shared_ptr<const Build>> Backend::evaluate(const Shape& shape) {
  AFTERGLOW_TRY(auto build, source_->evaluate(shape));
  shape_ = shape;
  seen_.reset();
  if (const std::string& space = preset().input_space(); !space.empty())
    diagnostics_.warn_once(
        "input_space " + space,
        fmt::format("input_space = \"{}\" of the look is for files: pictures of a host are scene-linear "
                    "floats or sRGB codes, and are taken as these",
                    space));
  return build;
}

Result<void> Backend::prepare_frame(const Shape& shape) {
  AFTERGLOW_TRY(auto build, evaluate(shape));
  Stack& stack = source_->stack();
  AFTERGLOW_CHECK(stack.prepare(request_for(build, shape.encoding, shape.region)));
  prepared_ = true;
  build_ = std::move(build);
  skipped_ = stack.skipped();
  last_ = {};
  return {};
}

Result<void> Backend::run(const Shape& shape, const std::map<std::string, HostImage>& inputs, HostResult& result) {
  Forgetting forgetting(*this);
  auto done = run_frame(shape, inputs, result);
  if (done) forgetting.dismiss();
  return done;
}

Result<void> Backend::run_frame(const Shape& shape, const std::map<std::string, HostImage>& inputs,
                                HostResult& result) {
  clamped_ = 0;
  AFTERGLOW_TRY(auto build, evaluate(shape));
  Stack& stack = source_->stack();
  AFTERGLOW_TRY(RenderRequest request, stack.request(request_for(build, shape.encoding, shape.region)));
  const bool runs = request.work.runs();
  if (!runs) {
    AFTERGLOW_CHECK(stack.programs()->prepare(std::move(request.work), stack.shaders()));
    request = {};  // the result is the source
  }
  request.inputs = inputs;
  if (runs && options_.time_kernels)
    request.timing = device_->device->timestamps_mean_draws() ? KernelTiming::timestamps : KernelTiming::submissions;
  AFTERGLOW_TRY(last_, renderer_->render(std::move(request), result));
  prepared_ = true;
  build_ = std::move(build);
  skipped_ = stack.skipped();
  clamped_ = result.clamped;
  return {};
}

namespace {
Error nothing_is_prepared() { return {ErrorKind::usage, "nothing is prepared: call afterglow_stack_prepare first"}; }
}  // namespace

Result<void> Backend::bind(const std::map<std::string, ImageBinding>& inputs, const ImageBinding& result) {
  if (!prepared_) return nothing_is_prepared();
  return source_->stack().bind(inputs, result);
}

Result<void> Backend::record(VkCommandBuffer commands) {
  if (!prepared_) return nothing_is_prepared();
  Stack& stack = source_->stack();
  if (!stack.runs()) return {};
  if (!stack.program()->bound())
    return Error{ErrorKind::usage, "no images are bound for what was prepared: call afterglow_stack_bind first"};
  stack.record(commands);
  last_.kernels.clear();
  for (const auto& kernel : stack.program()->plan().kernels) last_.kernels.push_back(kernel.name);
  last_.memory = stack.program()->memory();
  return {};
}

int Backend::pre_roll() const { return build_ ? afterglow::pre_roll(build_->graph) : 0; }

BackendReport Backend::report() const {
  const Stack& stack = source_->stack();
  BackendReport out;
  out.preset = options_.preset.string();
  out.device = device_->device->info().name;
  out.choice = execution_name(stack.choice().execution);
  out.choice_from = stack.choice().from;
  out.max_error = stack.choice().max_error;
  out.kernels = last_.kernels;
  out.skipped = skipped_;
  out.skipped.insert(out.skipped.end(), last_.skipped.begin(), last_.skipped.end());
  out.memory = last_.memory;
  out.clamped = clamped_;
  out.script = stack.script_milliseconds();
  out.compile = stack.compile_milliseconds();
  out.times = last_.times;
  return out;
}

}  // namespace afterglow::api
