// SPDX-License-Identifier: MIT
#include "window/thumbnails.h"

#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include "core/exception.h"
#include "core/file.h"
#include "core/give_way.h"
#include "edit/stack_edit.h"
#include "image/scale.h"
#include "image/srgb.h"
#include "session/live_session.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMostDeviceMemory = 256u << 20;

/// A frame made small, with what presets are told about it.
struct SmallFrame {
  Picture picture;
  BuildContext context;
};

SmallFrame small_frame(const ThumbnailFrame& frame) {
  auto whole = frame.read ? frame.read() : Result<Picture>(*frame.picture);
  SmallFrame out{whole ? std::move(whole).value() : *frame.picture, frame.context};
  const Size display = out.picture.display_window.size();
  const double scale = std::min({static_cast<double>(Thumbnail::kWidth) / std::max(display.width, 1),
                                 static_cast<double>(Thumbnail::kHeight) / std::max(display.height, 1), 1.0});
  const Size to{std::max(static_cast<int>(display.width * scale), 1),
                std::max(static_cast<int>(display.height * scale), 1)};
  out.picture.content.clear();
  if (scale < 1) scale_picture(out.picture, {.display = to});
  out.context.length_scale = scale;
  note_content(out.picture);
  return out;
}

/// In the middle of a thumbnail, as the window shows it: linear light clamped and sRGB-encoded, alpha ignored.
std::vector<std::uint32_t> encoded(const float* rgba, Size size) {
  std::vector<std::uint32_t> out(static_cast<std::size_t>(Thumbnail::kWidth) * Thumbnail::kHeight);
  const CodeEncoder& code = CodeEncoder::srgb(255);
  const int left = (Thumbnail::kWidth - size.width) / 2, top = (Thumbnail::kHeight - size.height) / 2;
  for (int y = std::max(-top, 0); y < size.height && y + top < Thumbnail::kHeight; ++y)
    for (int x = std::max(-left, 0); x < size.width && x + left < Thumbnail::kWidth; ++x) {
      const float* from =
          rgba + (static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x)) * 4;
      out[static_cast<std::size_t>(y + top) * Thumbnail::kWidth + static_cast<std::size_t>(x + left)] =
          code(from[0]) | code(from[1]) << 8 | code(from[2]) << 16 | 255u << 24;
    }
  return out;
}

/// The preset with an effect more, as the panel would add it. Its name in the new stack.
Result<std::string> add(const ThumbnailOf& of, PresetOptions& options) {
  if (!options.text) {
    AFTERGLOW_TRY(options.text, read_file(of.preset));
  }
  AFTERGLOW_TRY(auto rewrite, rewrite_stack(of.preset, *options.text, {StackEdit::Kind::add, of.added}, options));
  options.text = std::move(rewrite.text);
  for (Override& one : options.overrides)
    for (const auto& [before, now] : rewrite.renamed)
      if (one.entry == before) {
        one.entry = now;
        break;
      }
  return rewrite.entry;
}

Result<Thumbnail> make(Device& device, const ThumbnailOf& of, const StackOptions& stack, const SmallFrame& frame) {
  Diagnostics silent;  // warnings are told when it is opened
  LiveOptions options{.stack = stack};
  options.follow = false;
  PresetOptions& preset = options.stack.preset;
  if (of.changed) {
    preset.text = of.changed->text;
    preset.overrides = of.changed->overrides;
    preset.arguments = of.changed->arguments;
  }
  std::string entry;
  if (!of.added.empty()) {
    AFTERGLOW_TRY(entry, add(of, preset));
  }
  AFTERGLOW_TRY(const auto session, LiveSession::open(device, of.preset, options, silent));
  AFTERGLOW_CHECK(session->process(frame.picture, frame.context));
  const LiveStatus status = session->live().status();
  if (status.error) return *status.error;
  Thumbnail out;
  for (const Skipped& skipped : session->skipped())
    if (!entry.empty() && skipped.name == entry) out.note = skipped.reason;
  if (!session->images().ran) {
    out.pixels = encoded(frame.picture.color.pixels.data(), frame.picture.color.size());
    return out;
  }
  HostResult result;
  AFTERGLOW_CHECK(session->read_result(result));
  out.pixels = encoded(result.pixels.data(), session->images().result.binding.size);
  return out;
}

}  // namespace

struct Thumbnails::State {
  DeviceOptions device_options;
  StackOptions stack;
  std::function<void()> made;

  mutable std::mutex mutex;
  std::condition_variable changed;
  bool ends = false, rests = false;
  std::uint64_t generation = 0;  ///< of the frame
  std::optional<ThumbnailFrame> frame;
  std::vector<ThumbnailOf> wanted;
  std::map<ThumbnailOf, std::shared_ptr<const Thumbnail>> kept;
  std::thread thread;  // last: it uses the rest

  std::optional<ThumbnailOf> next() const {
    if (!frame) return std::nullopt;
    for (const ThumbnailOf& one : wanted)
      if (!kept.contains(one)) return one;
    return std::nullopt;
  }
  void run();
  void make_all(std::unique_lock<std::mutex>& lock);
};

/// With a device, until there is nothing more to do with it.
void Thumbnails::State::make_all(std::unique_lock<std::mutex>& lock) {
  std::unique_ptr<Device> device;
  std::optional<SmallFrame> small;
  std::uint64_t small_of = 0;
  while (!ends && !rests) {
    const auto one = next();
    if (!one) {
      changed.wait(lock);
      continue;
    }
    const std::uint64_t of = generation;
    const ThumbnailFrame source = *frame;
    lock.unlock();
    auto made_one = without_exceptions([&]() -> Result<Thumbnail> {
      if (!small || small_of != of) small = small_frame(source);
      small_of = of;
      Diagnostics silent;
      if (!device) {
        AFTERGLOW_TRY(device, Device::create(device_options, silent));
      }
      return make(*device, *one, stack, *small);
    });
    Thumbnail out;
    if (made_one) {
      out = std::move(*made_one);
    } else {
      out.error = made_one.error();
      if (out.error->kind == ErrorKind::device) device.reset();  // lost: the next one begins anew
    }
    lock.lock();
    const bool still = of == generation && std::ranges::find(wanted, *one) != wanted.end();
    if (!still || rests || ends) continue;
    kept[*one] = std::make_shared<const Thumbnail>(std::move(out));
    lock.unlock();
    made();
    lock.lock();
  }
  lock.unlock();
  small.reset();
  device.reset();
  lock.lock();
}

void Thumbnails::State::run() {
  give_way();
  std::unique_lock lock(mutex);
  while (!ends) {
    if (next() && !rests) make_all(lock);
    rests = false;
    if (!ends && !next()) changed.wait(lock);
  }
}

Thumbnails::Thumbnails(DeviceOptions device, StackOptions stack, std::function<void()> made)
    : state_(std::make_unique<State>()) {
  state_->device_options = std::move(device);
  state_->device_options.presentation = nullptr;
  state_->stack = std::move(stack);
  state_->stack.keep_images = false;
  state_->stack.spare_programs = 0;
  state_->stack.max_memory = std::min(state_->stack.max_memory, kMostDeviceMemory);
  state_->stack.preset.text.reset();
  state_->stack.preset.leave_out_unfit = true;
  state_->made = std::move(made);
  state_->thread = std::thread([state = state_.get()] { state->run(); });
}

Thumbnails::~Thumbnails() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->ends = true;
  }
  state_->changed.notify_all();
  state_->thread.join();
}

void Thumbnails::set_frame(ThumbnailFrame frame) {
  {
    const std::lock_guard lock(state_->mutex);
    ++state_->generation;
    state_->frame = std::move(frame);
    state_->kept.clear();
  }
  state_->changed.notify_all();
}

void Thumbnails::want(std::vector<ThumbnailOf> wanted) {
  if (wanted.size() > kMostKept) wanted.erase(wanted.begin() + kMostKept, wanted.end());
  {
    const std::lock_guard lock(state_->mutex);
    state_->wanted = std::move(wanted);
    std::erase_if(state_->kept, [&](const auto& one) {
      return std::ranges::find(state_->wanted, one.first) == state_->wanted.end();
    });
  }
  state_->changed.notify_all();
}

std::shared_ptr<const Thumbnail> Thumbnails::find(const ThumbnailOf& of) const {
  const std::lock_guard lock(state_->mutex);
  const auto found = state_->kept.find(of);
  return found == state_->kept.end() ? nullptr : found->second;
}

void Thumbnails::rest() {
  {
    const std::lock_guard lock(state_->mutex);
    ++state_->generation;
    state_->rests = true;
    state_->frame.reset();
    state_->wanted.clear();
    state_->kept.clear();
  }
  state_->changed.notify_all();
}

bool Thumbnails::busy() const {
  const std::lock_guard lock(state_->mutex);
  return state_->next().has_value();
}

}  // namespace afterglow
