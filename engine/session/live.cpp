// SPDX-License-Identifier: MIT
#include "session/live.h"

#include "core/stopwatch.h"
#include "script/asset_store.h"
#include "session/live_builder.h"

namespace afterglow {

struct LiveStack::State {
  State(Device& device, const std::filesystem::path& preset, const LiveOptions& options, Diagnostics& diagnostics)
      : overrides(options.stack.preset.overrides), builder(device, preset, options, diagnostics) {}

  std::optional<BuildContext> context;  ///< of the next frames
  std::optional<DisplayEncoding> encoding;
  std::vector<Override> overrides;
  std::string shown;

  std::shared_ptr<const FileProbes> followed;  ///< of frames
  std::uint64_t stacks_taken = 0;
  BuiltStack stack;
  mutable std::mutex mutex;
  std::shared_ptr<Heard> heard;  ///< by `stack`, for other threads
  LiveBuilder builder;           // its thread ends first
};

namespace {

/// Frames of the same shape are made by the same program, unless the preset says otherwise.
bool same_shape(const BuildContext& a, const BuildContext& b) {
  return a.size == b.size && a.auxiliary == b.auxiliary && a.asked == b.asked;
}

}  // namespace

std::string LiveStatus::error_text() const {
  if (!error) return {};
  std::string text = error->text();
  if (source_line.empty()) return text;
  const std::size_t end = std::min(text.find('\n'), text.size());
  return text.insert(end, "\n  " + source_line);
}

LiveStack::LiveStack(std::unique_ptr<State> state) : state_(std::move(state)) {}
LiveStack::~LiveStack() = default;

Result<std::unique_ptr<LiveStack>> LiveStack::open(Device& device, const std::filesystem::path& preset,
                                                   const LiveOptions& options, Diagnostics& diagnostics) {
  // Drivers of CPU devices compile a shader when it is first drawn with: half the rows take half the time, and a frame
  // hardly longer.
  constexpr int kRowsWhileEdited = 4;
  LiveOptions own = options;
  own.stack.most_rows = std::min(own.stack.most_rows, kRowsWhileEdited);
  if (!own.stack.preset.assets) own.stack.preset.assets = std::make_shared<AssetStore>();
  const auto& cache = options.stack.cache_folder;
  if (!own.stack.shared) {
    own.stack.shared = std::make_shared<SharedKernels>(cache.empty() ? cache : cache / "shaders");
    if (!cache.empty()) device.use_pipeline_cache((cache / "pipelines").string());
  }
  std::unique_ptr<LiveStack> live(new LiveStack(std::make_unique<State>(device, preset, own, diagnostics)));
  live->settle();
  live->update();
  return live;
}

Stack* LiveStack::stack() { return state_->stack.stack.get(); }

bool LiveStack::update() {
  State& s = *state_;
  BuiltParts parts = s.builder.take();
  if (!parts.any()) return false;
  if (parts.structure) {
    const bool for_frame = parts.structure->for_frame;
    // Effects that look back go on where they were.
    if (s.stack.stack && parts.structure->stack) parts.structure->stack->take_over(*s.stack.stack, for_frame);
    parts.for_frame = for_frame;
    std::swap(s.stack, *parts.structure);
    ++s.stacks_taken;
    if (parts.structure->stack) s.builder.release(std::move(*parts.structure));
  }
  if (parts.values) {
    if (s.stack.stack) parts.values->stack->take_over(*s.stack.stack, true);
    std::swap(s.stack, *parts.values);
    s.builder.release(std::move(*parts.values));
  }
  s.followed = s.stack.files;
  {
    const std::lock_guard lock(s.mutex);
    s.heard = s.stack.heard;
  }
  s.builder.forward([&](LiveStatus& status, Counters& counters) {
    ++status.generation;
    status.times = parts.times;
    status.times.wait = milliseconds_since(parts.done);
    ++(parts.structure ? counters.structures : counters.values);
    if (parts.for_frame) ++counters.for_frames;
  });
  return true;
}

void LiveStack::set_context(const BuildContext& context, const std::optional<DisplayEncoding>& encoding) {
  State& s = *state_;
  const bool build = !s.context || !same_shape(*s.context, context) || s.encoding != encoding;
  s.context = context;
  s.encoding = encoding;
  s.builder.change(
      [&](LiveRequest& request) {
        request.context = context;
        request.encoding = encoding;
      },
      build);
}

void LiveStack::build_for_frame() {
  state_->builder.change([](LiveRequest& request) { request.for_frame = true; }, true);
}

std::uint64_t LiveStack::stacks_taken() const { return state_->stacks_taken; }
std::vector<std::string> LiveStack::wants() const { return state_->builder.wants(); }
bool LiveStack::building() const { return state_->builder.building(); }

void LiveStack::set_overrides(std::vector<Override> overrides) {
  state_->overrides = overrides;
  state_->builder.change([&](LiveRequest& request) { request.overrides = std::move(overrides); }, true);
}

void LiveStack::set_overrides(std::vector<Override> overrides, std::vector<ArgumentValue> arguments,
                              std::shared_ptr<const std::string> text) {
  state_->overrides = overrides;
  state_->builder.change(
      [&](LiveRequest& request) {
        request.overrides = std::move(overrides);
        request.arguments = std::move(arguments);
        request.text = std::move(text);
      },
      true);
}

const std::vector<Override>& LiveStack::overrides() const { return state_->overrides; }

void LiveStack::show(const std::string& image) {
  if (state_->shown == image) return;
  state_->shown = image;
  state_->builder.change([&](LiveRequest& request) { request.shown = image; }, true);
}

const std::string& LiveStack::shown() const { return state_->shown; }

std::vector<std::string> LiveStack::images() const {
  return state_->stack.stack ? state_->stack.stack->images() : std::vector<std::string>{};
}

void LiveStack::also_follow(const std::shared_ptr<const FileProbes>& looks) {
  if (looks == state_->followed) return;
  state_->followed = looks;
  state_->builder.also_follow(*looks);
}

void LiveStack::reload() { state_->builder.look(); }
void LiveStack::settle() { state_->builder.settle(); }
LiveStack::Counters LiveStack::counters() const { return state_->builder.counters(); }

LiveStatus LiveStack::status() const {
  LiveStatus status = state_->builder.status();
  std::shared_ptr<Heard> heard;
  {
    const std::lock_guard lock(state_->mutex);
    heard = state_->heard;
  }
  if (!heard) return status;
  const std::lock_guard lock(heard->mutex);
  status.warnings = heard->warnings;
  status.notes = heard->notes;
  return status;
}

}  // namespace afterglow
