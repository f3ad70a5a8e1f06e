// SPDX-License-Identifier: MIT
#include "session/session.h"

#include <deque>
#include <future>
#include <set>

#include "core/beside.h"
#include "core/exception.h"
#include "core/locale.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "exec/cpu/warm_up.h"
#include "image/encode.h"
#include "session/picture_inputs.h"

namespace afterglow {
namespace {

/// Whether the codes have no alpha somewhere in `part` where the picture has some.
bool lost_alpha(const Picture& picture, const Rect& part) {
  std::vector<float> memory;
  for (int y = part.y; y < part.y + part.height; ++y) {
    const float* row = color_row(picture, y, memory);
    const std::size_t first = 4 * static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.color.width);
    for (int x = part.x; x < part.x + part.width; ++x) {
      const std::size_t alpha = 4 * static_cast<std::size_t>(x) + 3;
      if (picture.unorm8[first + alpha] == 0 && row[alpha] >= 1.0f / 255) return true;
    }
  }
  return false;
}

}  // namespace

struct Session::State {
  struct OpenedDevice {
    Result<std::unique_ptr<Device>> device;
    double milliseconds = 0;
  };
  static OpenedDevice open_device(const DeviceOptions& options, Diagnostics& diagnostics) {
    const auto start = Clock::now();
    auto device = Device::create(options, diagnostics);
    return {std::move(device), milliseconds_since(start)};
  }

  SessionOptions options;
  std::string preset_file;
  // Destroyed in reverse: what was made on the device goes before the device.
  std::future<OpenedDevice> opening;
  std::optional<Error> failed;  ///< it did not open
  std::unique_ptr<Device> device;
  std::unique_ptr<Stack> stack;
  /// A frame that is in flight.
  struct Frame {
    Picture picture;
    std::optional<DisplayEncoding> encoding;
    std::optional<Rect> region;
    std::vector<Skipped> skipped;
    bool runs = false;
    bool codes = false;  ///< the result are 8-bit codes
  };
  std::deque<Frame> frames;  ///< the renderer reads their pictures
  std::unique_ptr<Renderer> renderer;
  std::unique_ptr<Tracer> tracer;  ///< once a frame was traced
  FrameReport last;                ///< of the frame that was collected last
  std::vector<Skipped> skipped;    ///< by no frame like that one
  HostResult result;
  bool flagged = false;  ///< the last frame's result
  SessionTimes times;
  Diagnostics* diagnostics = nullptr;
  std::set<std::string> looked_for;  ///< objects of cryptomattes that the first pictures were asked for
  std::future<void> warming_up;      ///< first to go: it is waited for

  Result<void> use(OpenedDevice opened);
  void warm_up(const Program& program);
  Result<void> submit(Picture& picture, FrameRequest request);
  Result<void> begin(const Picture& picture, Frame& frame, FrameRequest request);
};

Session::Session(std::unique_ptr<State> state) : state_(std::move(state)) {}
Session::~Session() = default;

Stack& Session::stack() { return *state_->stack; }
Device& Session::device() { return *state_->device; }

Result<std::unique_ptr<Session>> Session::open(const std::filesystem::path& preset, const SessionOptions& options,
                                               Diagnostics& diagnostics) {
  AFTERGLOW_TRY(auto session, begin(preset, options, diagnostics));
  AFTERGLOW_CHECK(session->ready());
  return session;
}

Result<std::unique_ptr<Session>> Session::begin(const std::filesystem::path& preset, const SessionOptions& options,
                                                Diagnostics& diagnostics) {
  auto state = std::make_unique<State>();
  state->options = options;
  state->preset_file = preset.string();
  state->diagnostics = &diagnostics;
  AFTERGLOW_TRY(state->stack, Stack::load(preset, options.stack, diagnostics));
  return std::unique_ptr<Session>(new Session(std::move(state)));
}

void Session::begin_opening() {
  State& s = *state_;
  if (s.device || s.failed || s.opening.valid()) return;
  parallel_for(2, [](std::size_t) {});  // loops find their threads there
  s.opening = beside(
      [options = s.options.device, &diagnostics = *s.diagnostics] { return State::open_device(options, diagnostics); });
}

Result<void> Session::ready() {
  State& s = *state_;
  begin_opening();
  if (s.opening.valid()) {
    auto done = s.use(s.opening.get());
    if (!done) s.failed = std::move(done).error();
  }
  if (s.failed) return *s.failed;
  return {};
}

Result<void> Session::State::use(OpenedDevice opened) {
  if (!opened.device) return std::move(opened.device).error();
  device = std::move(opened.device).value();
  times.device = opened.milliseconds;
  stack->use(*device, true);
  // Timestamps around deferred draws mean nothing: there, each kernel is timed in a submission of its own.
  if (options.timing == KernelTiming::timestamps && !device->timestamps_mean_draws())
    options.timing = KernelTiming::submissions;
  AFTERGLOW_TRY(renderer, Renderer::create(*device, {.max_memory = options.stack.max_memory,
                                                     .direct = options.direct,
                                                     .frames = options.frames}));
  return {};
}

int Session::frames() const { return state_->renderer ? state_->renderer->frames() : 1; }
int Session::in_flight() const { return static_cast<int>(state_->frames.size()); }

Result<void> Session::prepare(FrameRequest frame) {
  constexpr int kWorthIt = 2;
  AFTERGLOW_CHECK(state_->renderer->wait());
  const KernelCompiler& compiler = state_->stack->programs()->kernels()->compiler;
  const int before = compiler.counters().compiled;
  AFTERGLOW_CHECK(state_->stack->prepare(std::move(frame)));
  state_->skipped = state_->stack->skipped();
  // What goes wrong there goes wrong again in the frame.
  const auto usual = state_->renderer->warm_up(*state_->stack->programs(), state_->stack->shaders());
  if (usual && *usual && compiler.counters().compiled - before >= kWorthIt) state_->warm_up(**usual);
  return {};
}

/// Kernels that were compiled here are new to the driver too: it compiles them one after the other, on one thread.
/// Another one begins at their other end meanwhile.
void Session::State::warm_up(const Program& program) {
  const ProgramCache& programs = *stack->programs();
  if (warming_up.valid() || options.stack.reference || !WarmUp::helps(*device)) return;
  ProgramOptions wanted = programs.program_options();
  warming_up = beside([&device = *device, kernels = programs.kernels(), path = stack->shaders().path(),
                       graph = program.graph(), wanted = std::move(wanted)] {
    const PlainLocale plain;
    auto other = WarmUp::create(device);
    if (!other) return;
    ShaderLibrary shaders(path);  // that of the stack is looked for elsewhere as scripts say
    (void)(*other)->draw(shaders, kernels->compiler, graph, wanted);
  });
}

Result<void> Session::process(Picture& picture, const BuildContext& frame,
                              const std::optional<DisplayEncoding>& encoding, const std::optional<Rect>& region) {
  AFTERGLOW_TRY(auto build, evaluate(context_of(picture, frame)));
  return process(picture, request_for(std::move(build), encoding, region));
}

Result<void> Session::process(Picture& picture, FrameRequest request) {
  State& s = *state_;
  if (!s.frames.empty()) return Error{ErrorKind::other, "frames are in flight"};
  auto submitted = s.submit(picture, std::move(request));
  return submitted ? collect(picture) : submitted;
}

Result<void> Session::submit(Picture picture, FrameRequest request) {
  return state_->submit(picture, std::move(request));
}

/// Takes the picture; on errors it stays. From `submit` of the renderer on its pixels are read, whatever is thrown.
Result<void> Session::State::submit(Picture& picture, FrameRequest request) {
  for (const CryptomatteObject& object : request.build->depends.objects)
    if (looked_for.insert(object.layer + "/" + object.name).second) warn_if_absent(object, picture, *diagnostics);
  Frame& frame =
      frames.emplace_back(Frame{.picture = {}, .encoding = request.encoding, .region = request.region, .skipped = {}});
  auto begun = without_exceptions([&] { return begin(picture, frame, std::move(request)); });
  if (!begun) {
    frames.pop_back();
    return begun;
  }
  if (frame.runs) picture.content.erase("source");
  frame.picture = std::move(picture);
  frame.skipped = stack->skipped();
  return {};
}

Result<void> Session::State::begin(const Picture& picture, Frame& frame, FrameRequest request) {
  AFTERGLOW_TRY(RenderRequest render, stack->request(std::move(request)));
  frame.runs = render.work.runs();
  if (!frame.runs) {
    AFTERGLOW_CHECK(renderer->wait());
    return stack->programs()->prepare(std::move(render.work), stack->shaders());
  }
  frame.codes = render.work.unorm8;
  render.inputs = picture_inputs(picture, render.work.graph);
  render.timing = options.timing;
  return renderer->submit(std::move(render));
}

Result<void> Session::collect(Picture& picture) {
  State& s = *state_;
  if (s.frames.empty()) return Error{ErrorKind::other, "no frame is in flight"};
  s.renderer->launch();  // the picture's pixels are read until then
  State::Frame frame = std::move(s.frames.front());
  s.frames.pop_front();
  UnsetVector<std::uint8_t> codes = std::move(picture.unorm8);
  picture = std::move(frame.picture);
  s.last = {};
  s.times.frame = {};
  s.result.clamped = 0;
  s.flagged = s.result.flagged = false;
  s.skipped = std::move(frame.skipped);
  if (!frame.runs) return {};

  // The result replaces the source in its own memory. Effects never change alpha: the source's own values stay where
  // they are, exact whatever the storage format.
  HostResult& result = s.result;
  if (!frame.codes) open_color(picture);
  result.pixels = std::move(picture.color.pixels);
  result.unorm8 = std::move(codes);
  result.keep_alpha = true;
  auto report = s.renderer->collect(result);
  picture.color.pixels = std::move(result.pixels);
  picture.unorm8 = std::move(result.unorm8);
  if (!report) return std::move(report).error();
  s.last = std::move(*report);
  s.times.frame = s.last.times;
  s.flagged = result.flagged;
  if (result.flagged && frame.encoding && frame.encoding->straight_alpha && !picture.unorm8.empty())
    s.flagged = lost_alpha(picture, frame.region.value_or(Rect{0, 0, picture.color.width, picture.color.height}));
  return {};
}

Result<Trace> Session::trace(const Picture& picture, const FrameRequest& request, NanPolicy policy) {
  AFTERGLOW_CHECK(state_->renderer->wait());
  AFTERGLOW_CHECK(state_->stack->prepare(request));
  if (!state_->tracer) state_->tracer = std::make_unique<Tracer>(*state_->device, state_->options.stack.max_memory);
  return state_->tracer->run(*state_->stack, picture, request, policy);
}

void Session::forget_clamped() { state_->result.clamped = 0; }

std::vector<std::string> Session::take_replaced_histories() {
  return state_->stack->programs()->take_replaced_histories();
}

SessionReport Session::report() const {
  const Stack& stack = *state_->stack;
  SessionReport report;
  report.device = state_->device->info().name;
  report.driver = state_->device->info().driver;
  report.preset = state_->preset_file;
  report.choice = stack.choice();
  report.reference = state_->options.stack.reference;
  report.skipped = state_->skipped;
  report.skipped_now = state_->last.skipped;
  report.counters = {.programs = state_->stack->programs()->programs(),
                     .images = state_->renderer->counters().images,
                     .buffers = state_->renderer->counters().buffers,
                     .evaluations = state_->stack->preset().evaluations()};
  report.kernels = state_->last.kernels;
  report.memory = state_->last.memory;
  report.clamped = state_->result.clamped;
  report.flagged = state_->flagged;
  report.times = state_->times;
  report.times.script = stack.script_milliseconds();
  report.times.compile = stack.compile_milliseconds();
  return report;
}

}  // namespace afterglow
