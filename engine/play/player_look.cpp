// SPDX-License-Identifier: MIT
// What one asks a player about the frame on screen, and what one tells it to play.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "image/metadata.h"
#include "image/picture.h"
#include "image/sequence.h"
#include "play/player.h"
#include "play/player_state.h"
#include "script/schema.h"

namespace afterglow {
namespace {

/// The pixel of an image of another size that lies under the same place.
Pixel scaled(Pixel pixel, Size from, Size to) {
  if (from == to) return pixel;
  const auto along = [](int at, int length, int other) {
    return std::min(static_cast<int>((at + 0.5) * other / length), other - 1);
  };
  return {along(pixel.x, from.width, to.width), along(pixel.y, from.height, to.height)};
}

/// Where a region of the picture lies in an image of another size.
Rect scaled(Rect region, Size from, Size to) {
  if (from == to || region.size().area() == 0) return region;
  const Pixel first = scaled(Pixel{region.x, region.y}, from, to);
  const Pixel last = scaled(Pixel{region.x + region.width - 1, region.y + region.height - 1}, from, to);
  return {first.x, first.y, last.x - first.x + 1, last.y - first.y + 1};
}

std::array<float, 4> value_at(const Image& image, Pixel pixel) {
  std::array<float, 4> out{};
  std::copy_n(image.at(pixel.x, pixel.y), 4, out.begin());
  return out;
}

/// One pixel of what a preset made of the picture.
Result<std::array<float, 4>> result_at(LiveSession& session, HostResult& result, const Picture& picture, Size whole,
                                       Pixel pixel) {
  const DeviceImages images = session.images();
  if (!images.ran) return value_at(picture.color, scaled(pixel, whole, picture.color.size()));
  const Size size = images.result.binding.size;
  const Pixel at = scaled(pixel, whole, size);
  AFTERGLOW_CHECK(session.read_result(result, Rect{at.x, at.y, 1, 1}));
  std::array<float, 4> out{};
  const std::size_t first =
      (static_cast<std::size_t>(at.y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(at.x)) * 4;
  std::copy_n(result.pixels.begin() + static_cast<std::ptrdiff_t>(first), 4, out.begin());
  return out;
}

}  // namespace

PlayerImages Player::images() const {
  const State& s = *state_;
  if (!s.picture) return {};
  const DeviceImages images = s.first->images();
  PlayerImages out{.source = images.source,
                   .result = images.ran ? images.result : images.source,
                   .other = {},
                   .picture = s.shown.size};
  if (s.second && s.second_runs) {
    const DeviceImages other = s.second->images();
    out.other = other.ran ? other.result : other.source;
  }
  return out;
}

Result<std::optional<Probe>> Player::probe(Pixel pixel) {
  State& s = *state_;
  if (!s.picture || pixel.x < 0 || pixel.y < 0 || pixel.x >= s.shown.size.width || pixel.y >= s.shown.size.height)
    return std::optional<Probe>();
  const Picture& picture = s.picture->picture;
  const Size whole = s.shown.size;
  Probe probe{.pixel = pixel,
              .source = value_at(picture.color, scaled(pixel, whole, picture.color.size())),
              .result = {},
              .other = {}};
  AFTERGLOW_TRY(probe.result, result_at(*s.first, s.result, picture, whole, pixel));
  if (s.second && s.second_runs) {
    AFTERGLOW_TRY(probe.other, result_at(*s.second, s.result, picture, whole, pixel));
  }
  return std::optional<Probe>(probe);
}

/// What a preset made of the picture, whole. Holds until the next reading.
struct Player::State::Looked {
  std::span<const float> pixels;
  Size size;
};
Result<Player::State::Looked> Player::State::look(Of of) {
  const Image& source = picture->picture.color;
  if (of == Of::source) return Looked{source.pixels, source.size()};
  LiveSession& session = of == Of::other ? *second : *first;
  const DeviceImages images = session.images();
  if (!images.ran) return Looked{source.pixels, source.size()};
  AFTERGLOW_CHECK(session.read_result(result));
  return Looked{result.pixels, images.result.binding.size};
}

Result<Scopes> Player::scopes(const ScopeOptions& options, Of of) {
  State& s = *state_;
  if (!s.picture || (of == Of::other && !(s.second && s.second_runs))) return scopes_of({}, {}, options);
  AFTERGLOW_TRY(const State::Looked looked, s.look(of));
  ScopeOptions wanted = options;
  const Size size = s.shown.size;
  if (wanted.region) wanted.region = scaled(within(*wanted.region, size), size, looked.size);
  return scopes_of(looked.pixels, looked.size, wanted);
}

Result<std::optional<RegionMeans>> Player::means(Rect region) {
  State& s = *state_;
  if (!s.picture) return std::optional<RegionMeans>();
  const Size size = s.shown.size;
  RegionMeans out{.region = within(region, size), .source = {}, .result = {}, .other = {}};
  if (out.region.size().area() == 0) return std::optional<RegionMeans>();
  const auto mean = [&](Of of) -> Result<RegionMean> {
    AFTERGLOW_TRY(const State::Looked looked, s.look(of));
    return mean_of(looked.pixels, looked.size, scaled(out.region, size, looked.size));
  };
  AFTERGLOW_TRY(out.source, mean(Of::source));
  AFTERGLOW_TRY(out.result, mean(Of::result));
  if (s.second && s.second_runs) {
    AFTERGLOW_TRY(out.other, mean(Of::other));
  }
  return std::optional<RegionMeans>(out);
}

/// Runs the whole picture once, where a proxy is shown; the next turn shows the proxy again.
Result<Picture> Player::State::whole_frame() {
  AFTERGLOW_TRY(Picture whole, footage->read_whole(footage->frame(shown.position).picture, needs_now(), diagnostics));
  BuildContext frame = context(shown.position, 1);
  if (whole.facts) frame.position = camera_position(whole.facts->metadata);
  first->build_aside(false);
  dirty = true;
  ran.reset();
  AFTERGLOW_CHECK(first->process(whole, frame));
  return whole;
}

/// Files hold finite colours, as those of `run` do.
void Player::State::mend(Image& color) {
  const NonFinite found = find_non_finite(color);
  if (found.count() == 0) return;
  for (float& value : color.pixels)
    if (!std::isfinite(value)) value = 0;
  diagnostics.warn(
      fmt::format("the result holds {}, first at {}; they are replaced by 0", found.text(), found.first->text()));
}

Result<Picture> Player::screenshot() {
  State& s = *state_;
  if (!s.picture) return Error{ErrorKind::other, "no picture is shown"};
  Picture out;
  if (s.picture_proxy > 1 && s.shown.position >= 0) {
    AFTERGLOW_TRY(out, s.whole_frame());
  } else {
    out = s.picture->picture;
  }
  out.content.clear();
  if (!s.first->live().stack())
    return Error{ErrorKind::script, "the preset has no version that runs yet; nothing is written"};
  const DeviceImages images = s.first->images();
  if (!images.ran) return out;
  AFTERGLOW_CHECK(s.first->read_result(s.result));
  const Size size = images.result.binding.size;
  if (size != out.color.size()) {  // an image between passes
    out.color = Image(size.width, size.height, 4);
    out.color.pixels = s.result.pixels;
    s.mend(out.color);
    out.data_window = out.display_window = {0, 0, size.width, size.height};
    out.auxiliary.clear();
    return out;
  }
  // Effects never change alpha: the source's own values stay, exact whatever the storage format.
  const std::size_t pixels = out.color.pixels.size() / 4;
  for (std::size_t i = 0; i < pixels; ++i)
    std::copy_n(s.result.pixels.begin() + static_cast<std::ptrdiff_t>(i * 4), 3,
                out.color.pixels.begin() + static_cast<std::ptrdiff_t>(i * 4));
  s.mend(out.color);
  return out;
}

void Player::State::apply_edits() {
  const PresetOptions& given = options.live.stack.preset;
  first->live().set_overrides(edits.overrides(given.overrides), edits.arguments(given.arguments), edits.stack_text());
}

void Player::set(const std::string& entry, const std::string& setting, const SettingValue& value) {
  state_->edits.set(entry, setting, value);
  state_->apply_edits();
}

void Player::reset(const std::string& entry, const std::string& setting) {
  if (state_->edits.reset(entry, setting)) state_->apply_edits();
}

void Player::set_all(const std::vector<SettingEdit>& values) {
  state_->edits.set_all(values);
  state_->apply_edits();
}

void Player::set_stack(const StackChange& change) {
  state_->edits.set_stack(change);
  state_->apply_edits();
}

void Player::reset_stack() {
  if (state_->edits.reset_stack()) state_->apply_edits();
}

void Player::reset_all() {
  if (state_->edits.reset_all()) state_->apply_edits();
}

bool Player::undo() {
  const bool done = state_->edits.undo();
  if (done) state_->apply_edits();
  return done;
}

bool Player::redo() {
  const bool done = state_->edits.redo();
  if (done) state_->apply_edits();
  return done;
}

void Player::take_back() {
  if (state_->edits.take_back()) state_->apply_edits();
}

void Player::keep_snapshot(int snapshot) { state_->edits.keep(snapshot); }

bool Player::recall_snapshot(int snapshot) {
  const bool done = state_->edits.recall(snapshot);
  if (done) state_->apply_edits();
  return done;
}

const SettingEdits& Player::edits() const { return state_->edits; }
void Player::end_gesture() { state_->edits.end_gesture(); }

/// What was written counts from here on, in place of what the command line says of the same setting. That is what was
/// on screen before.
void Player::State::take_the_place_of_given(std::vector<BaseChange>& changes) {
  Stack* stack = first->live().stack();
  if (!stack) return;
  const Preset& preset = stack->preset();
  const auto means = [&](const Override& given, const StackEntry& entry) {
    const bool name = std::ranges::find(preset.entries(), given.entry, &StackEntry::name) != preset.entries().end();
    return given.entry == (name ? entry.name : entry.effect);
  };
  std::vector<Override>& given = options.live.stack.preset.overrides;
  for (BaseChange& change : changes) {
    const auto entry = std::ranges::find(preset.entries(), change.entry, &StackEntry::name);
    if (entry == preset.entries().end()) continue;
    const auto schema = preset.setting_schema(*entry, change.setting);
    std::vector<Override> left;
    for (const Override& one : given) {
      if (one.setting != change.setting || !means(one, *entry)) {
        left.push_back(one);
        continue;
      }
      if (schema)
        if (const auto value = script::parse_setting(one, *schema, "--set ")) change.before = *value;
      for (const StackEntry& other : preset.entries())  // that it says the same of
        if (&other != &*entry && means(one, other)) left.push_back({other.name, one.setting, one.value});
    }
    given = std::move(left);
  }
}

void Player::rebase(const std::vector<BaseChange>& changes) {
  std::vector<BaseChange> written = changes;
  state_->take_the_place_of_given(written);
  state_->edits.rebase(written);
  state_->apply_edits();
}

void Player::rebase(const std::vector<BaseChange>& changes, const TextChange& text) {
  std::vector<BaseChange> written = changes;
  state_->take_the_place_of_given(written);
  state_->edits.rebase(written, text);
  state_->apply_edits();
}

void Player::show(const std::string& image) { state_->first->live().show(image); }

void Player::set_proxy(int proxy) {
  State& s = *state_;
  if (proxy == s.footage->proxy()) return;
  s.options.footage.proxy = proxy;
  s.footage = s.footage->at_proxy(proxy);
  s.begin_reading();
  s.want_pictures();
  s.reread = true;
  s.ran.reset();
}

int Player::proxy() const { return state_->footage->proxy(); }

void Player::reload_pictures() {
  State& s = *state_;
  s.ahead->forget();
  s.reread = true;
}

Result<void> Player::open_footage(const std::vector<std::string>& inputs) {
  State& s = *state_;
  FootageOptions wanted = s.options.footage;
  wanted.inputs = inputs.size() > 1 && wanted.whole_sequences ? in_sequences(inputs) : inputs;
  wanted.frames.clear();
  const std::vector<std::string> asked = wanted.inputs;
  const bool before_said = s.footage->fps().has_value();
  const bool was_playing = s.transport.playing();
  AFTERGLOW_CHECK(s.open_row(std::move(wanted)));
  const bool stands = s.options.footage.inputs != asked;  // at the frame of a sequence that was asked for
  // A rate that the footage before said is not that of pictures which say none.
  if (!s.options.fps && (s.footage->fps() || before_said)) s.transport.set_fps(s.usual_fps(), s.now());
  s.begin_reading();
  s.want_pictures();
  s.shown.position = -1;
  s.forget_finite();
  s.dirty = true;
  if (was_playing && !stands) s.transport.play(s.now());
  return {};
}

std::function<Result<Picture>()> Player::reader_with_inputs() const {
  const State& s = *state_;
  if (s.shown.position < 0 || !s.picture) return {};
  const int key = s.footage->frame(s.shown.position).picture;
  FootageNeeds needs = s.needs;
  for (const char* name : {"depth", "normal", "motion"})
    if (std::ranges::find(needs.auxiliary, name) == needs.auxiliary.end()) needs.auxiliary.emplace_back(name);
  const ReadOptions& read = s.options.footage.read;
  const bool beside = read.depth.given() || read.normal.given() || read.motion.given();
  if (needs == s.needs || (s.footage->movie(key) && !beside)) return {};
  return [footage = s.footage, key, needs]() -> Result<Picture> {
    Diagnostics silent;  // it was read before
    return footage->read(key, needs, silent);
  };
}

Result<void> Player::open_preset(const std::filesystem::path& preset) {
  State& s = *state_;
  AFTERGLOW_TRY(auto opened, LiveSession::open(s.device, preset, s.live_options(s.options.live.stack.preset.overrides),
                                               s.diagnostics));
  s.first = std::move(opened);
  s.options.preset = preset;
  s.measured = 0;
  s.forget_finite();
  s.edits = {};
  s.dirty = true;
  s.follow_needs();
  return {};
}

Result<void> Player::open_other(const std::filesystem::path& preset) {
  State& s = *state_;
  AFTERGLOW_TRY(auto opened, LiveSession::open(s.device, preset, s.live_options(s.options.live.stack.preset.overrides),
                                               s.diagnostics));
  s.second = std::move(opened);
  s.second_runs = false;
  s.options.other_preset = preset;
  s.follow_needs();
  return {};
}

double Player::fps() const { return state_->figures.fps(); }

std::uint64_t Player::frames_had() const { return state_->figures.frames_had(); }
std::uint64_t Player::late() const { return state_->figures.late; }
void Player::time_kernels(bool on) { state_->time_kernels = on; }
std::vector<KernelTime> Player::kernel_times() const { return state_->first->kernel_times(); }

void Player::presented() {
  State& s = *state_;
  s.figures.presented((s.now() - s.turn_ended) * 1000);
}

PlayerStats Player::stats() const {
  PlayerStats stats = state_->figures.stats();
  stats.dropped = state_->transport.dropped();
  stats.cache = state_->ahead->stats();
  return stats;
}

}  // namespace afterglow
