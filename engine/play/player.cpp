// SPDX-License-Identifier: MIT
#include "play/player.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <system_error>
#include <utility>

#include "core/stopwatch.h"
#include "image/metadata.h"
#include "play/player_state.h"

namespace afterglow {
namespace {

double steady_seconds() { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); }

/// A file or a script that fails spoils its frame; the device that fails spoils them all.
bool ends_playing(const Error& error) { return error.kind == ErrorKind::device; }

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

/// Whether its frames depend on those before them.
bool has_histories(LiveSession* session) {
  Stack* const stack = session ? session->live().stack() : nullptr;
  return stack && stack->build() && !stack->build()->graph.histories.empty();
}

/// The same of the frame that runs next: without a build yet nobody knows.
bool may_look_back(LiveSession* session) {
  Stack* const stack = session ? session->live().stack() : nullptr;
  return !stack || !stack->build() || has_histories(session);
}

}  // namespace

void Player::State::wake() {
  {
    const std::lock_guard lock(mutex);
    awake = true;
  }
  woken.notify_all();
  if (options.wake) options.wake();
}

LiveOptions Player::State::live_options(const std::vector<Override>& overrides) {
  LiveOptions live = options.live;
  live.stack.preset.overrides = overrides;
  live.stack.keep_images = true;  // after an edit only what it changes runs again
  live.stack.spare_programs = 3;  // of presets whose passes come and go with the frame
  live.warm_up = options.warm_up;
  live.inputs_follow = true;
  live.notify = [this, given = options.live.notify] {
    wake();
    if (given) given();
  };
  return live;
}

/// A file that is slow to come must not hold the player up: what is in the midst of one ends on a thread of its own.
void Player::State::end_reading() {
  std::erase_if(ending,
                [](const auto& one) { return one.wait_for(std::chrono::seconds(0)) == std::future_status::ready; });
  if (!ahead) return;
  ahead->want({});
  ahead->forget();
  try {
    ending.push_back(
        std::async(std::launch::async, [reader = std::move(ahead), watch = std::move(rendering)]() mutable {
          watch.reset();
          reader.reset();
        }));
  } catch (const std::system_error&) {  // no more threads to be had: they have ended here
  }
}

void Player::State::begin_reading() {
  end_reading();
  std::uint64_t reader = 0;
  {
    const std::lock_guard lock(mutex);
    reader = ++readers;
    read_footage = footage;
    unreadable.clear();
  }
  wanted_for.clear();
  ahead = std::make_unique<ReadAhead>(
      [this, reader](int key) -> Result<Picture> {
        const auto read_from = readable(reader);
        if (!read_from) return Error{ErrorKind::other, "is of the footage before"};  // nobody asks for it any more
        auto read = read_from->read(key, needs_now(), diagnostics);
        const std::lock_guard lock(mutex);
        if (reader != readers) return read;
        if (read) {
          unreadable.erase(key);
        } else {
          unreadable.insert(key);
        }
        return read;
      },
      options.read_ahead, [this] { wake(); });
  if (options.live.follow) rendering = std::make_unique<FootageWatch>(options.footage, footage, [this] { wake(); });
}

/// The due picture, then those that will be, as many as may fit.
void Player::State::want_pictures() {
  constexpr int kMostAhead = 256;
  // Where frames are dropped anyway, not all of them need to be read.
  const bool real_time = transport.pacing() == Pacing::real_time;
  const int stride = real_time ? std::max(1, static_cast<int>(std::abs(transport.speed()) / 2)) : 1;
  const std::vector<int> made_for{transport.position(), transport.heading(), stride, static_cast<int>(transport.loop()),
                                  transport.first(),    transport.last()};
  if (made_for == wanted_for) return;
  wanted_for = made_for;
  std::vector<int> keys;
  std::set<int> seen;
  const auto add = [&](int position) {
    const int key = footage->frame(position).picture;
    if (seen.insert(key).second) keys.push_back(key);
  };
  add(transport.position());
  for (const int position : transport.upcoming(kMostAhead, stride)) add(position);
  // Decoders of videos go forwards: what is wanted backwards is read in runs that do.
  if (footage->is_video() && transport.heading() < 0) {
    constexpr std::ptrdiff_t kRun = 12;
    for (auto run = keys.begin() + 1; keys.end() - run > 1; run += std::min(kRun, keys.end() - run))
      std::sort(run, run + std::min(kRun, keys.end() - run));
  }
  ahead->want(keys);
}

/// Inputs that depend on the frame are known before its picture is read; of further frames once they are run.
void Player::State::ask_frames(Preset& preset) const {
  constexpr int kMostFrames = 1000;
  for (int position = 0; position < std::min(footage->frames(), kMostFrames); ++position)
    if (!preset.note_needs(context(position, 1))) return;  // told when it is evaluated
}

/// Whether the frame that was run asked for inputs that pictures have not been read with.
bool Player::State::wants_more() const {
  for (LiveSession* session : {first.get(), second.get()}) {
    Stack* const stack = session ? session->live().stack() : nullptr;
    if (!stack || !stack->preset().may_change()) continue;
    for (const std::string& name : stack->preset().needs())
      if (!contains(needs.auxiliary, name)) return true;
  }
  return false;
}

/// Inputs that looks wait for which were edited, and cannot be built without.
std::set<std::string> Player::State::awaited() const {
  std::set<std::string> out;
  for (LiveSession* session : {first.get(), second.get()}) {
    if (!session) continue;
    const std::vector<std::string> wants = session->live().wants();
    out.insert(wants.begin(), wants.end());
  }
  return out;
}

/// Was the picture read for all that the looks want?
bool Player::State::was_asked(const Picture& read) const {
  const auto asked = [&](const std::string& name) { return contains(read.asked, name); };
  return std::ranges::all_of(std::array{first.get(), second.get()}, [&](LiveSession* session) {
    Stack* const stack = session ? session->live().stack() : nullptr;
    return !stack || std::ranges::all_of(stack->preset().needs(), asked);
  });
}

/// What the present stacks want of pictures: when they want more, or other colours, pictures are read again. Both looks
/// see the same ones, as the first has them read.
void Player::State::follow_needs() {
  const auto stack_of = [](const std::unique_ptr<LiveSession>& session) {
    return session ? session->live().stack() : nullptr;
  };
  Stack *const own = stack_of(first), *const other = stack_of(second);
  std::set<std::string> auxiliary;
  for (Stack* stack : {own, other}) {
    if (!stack) continue;
    ask_frames(stack->preset());
    for (const auto& name : stack->preset().needs()) auxiliary.insert(name);
  }
  auxiliary.merge(awaited());
  bool others = false;
  {
    const std::lock_guard lock(mutex);
    const FootageNeeds before = needs;
    auxiliary.insert(needs.auxiliary.begin(), needs.auxiliary.end());
    needs.auxiliary.assign(auxiliary.begin(), auxiliary.end());
    if (own) needs.input_space = own->preset().input_space();
    if (own) needs.keep_negative = own->preset().keeps_negative();
    others = needs != before;
  }
  if (own && other && options.footage.read.input_space.empty() &&
      own->preset().input_space() != other->preset().input_space())
    diagnostics.warn_once("input_space of --b",
                          "the two looks say different things of input_space; both see pictures as the first has them");
  if (own && other && !options.footage.read.keep_negative &&
      own->preset().keeps_negative().value_or(false) != other->preset().keeps_negative().value_or(false))
    diagnostics.warn_once("gamut of --b",
                          "the two looks say different things of gamut; both see pictures as the first has them");
  if (others && ahead) {
    ahead->forget();
    reread = true;
  }
}

void Player::State::take_builds() {
  bool changed = first->live().update();
  if (second && second->live().update()) changed = true;
  if (changed) dirty = reloaded = true;
  const std::set<std::string> more = awaited();
  const auto known = [&](const std::string& name) { return contains(needs.auxiliary, name); };
  if (changed || !std::ranges::all_of(more, known)) follow_needs();
}

/// Errors of builds, once each, for the terminal.
void Player::State::tell_errors() {
  const std::string error = first->live().status().error_text();
  if (error == told) return;
  told = error;
  if (!error.empty() && first->live().stack()) diagnostics.warn("the last good version plays on: " + error);
}

/// What runs at a part of its size has lengths of that part (docs/math.md, 23).
BuildContext Player::State::context(int position, int proxy) const {
  const FootageFrame& frame = footage->frame(position);
  BuildContext context;
  context.length_scale = 1.0 / proxy;
  context.frame = frame.number;
  context.fps = transport.fps();
  context.time = frame.time.value_or(frame.number / context.fps);
  return context;
}

/// Runs a picture through what it is compared with; true when the images are others now.
Result<bool> Player::State::run(const std::shared_ptr<const ReadPicture>& read, const Transport::Due& due) {
  const auto start = Clock::now();
  const bool compare = second && view.compare == Compare::other;
  const int proxy = read == picture ? picture_proxy : footage->proxy();
  BuildContext frame = context(due.position, proxy);
  if (read->picture.facts) frame.position = camera_position(read->picture.facts->metadata);
  // Effects that look back go on over frames that were dropped; after a jump they begin anew.
  if (transport.playing() && ran && due.tick > ran->tick && frame.frame > ran->number)
    frame.step = frame.frame - ran->number;
  const bool looks_back = may_look_back(first.get()) || (compare && may_look_back(second.get()));
  if (looks_back && shots.begins(*footage, due.position, read->picture)) {
    frame.restart = true;
    frame.step = 1;
  }
  // By the clock, a frame that must be built does not hold up the others.
  first->build_aside(transport.pacing() == Pacing::real_time);
  if (second) second->build_aside(transport.pacing() == Pacing::real_time);
  auto done = first->process(read->picture, frame, options.timing);
  if (done && first->waits()) return false;
  if (done && compare) done = second->process(read->picture, frame);
  shown.failed.reset();
  if (!done) {
    if (ends_playing(done.error())) return std::move(done).error();
    shown.failed = std::move(done).error();
    dirty = false;  // until something changes, it would fail again
    return true;
  }
  picture = read;
  picture_proxy = proxy;
  ran = {due.tick, frame.frame};
  if (looks_back) shots.shown();
  second_runs = compare;
  dirty = false;
  const Size size = read->picture.color.size();
  shown.size = {size.width * proxy, size.height * proxy};
  const double work = milliseconds_since(start);
  if (first->times().kernels_run == 0) ++figures.kept;
  figures.frame_shown(now(), work, transport.playing());
  // The first build is no reload. `process` takes builds too: the generation says what is on screen.
  if (const LiveStatus status = first->live().status(); status.generation != measured) {
    if (measured > 0 && status.times.kind != BuildTimes::Kind::frame)
      figures.reloaded({.build = status.times, .execute = work, .present = 0});
    measured = status.generation;
    follow_needs();
  } else if (wants_more()) {
    follow_needs();
  }
  return true;
}

/// Puts the frame that is due on screen, when its picture is there and it is another one than before.
Result<bool> Player::State::show_due(double now) {
  const Transport::Due due = transport.due(now);
  want_pictures();
  const bool compare_missing = second && view.compare == Compare::other && !second_runs && !shown.failed;
  if (!due.moved && !dirty && !reread && !compare_missing && shown.position == due.position) return false;
  const FootageFrame& frame = footage->frame(due.position);
  const auto read = ahead->find(frame.picture);
  const std::int64_t ran_tick = ran ? ran->tick : due.tick;  // what is on screen runs again in its own place
  if (!read) {
    if (transport.playing() && due.moved) ++figures.late;
    // An edit need not wait for the next picture: the one on screen shows it, unless it wants more of it.
    if (dirty && picture && shown.position >= 0 && was_asked(picture->picture))
      return run(picture, {shown.position, ran_tick, false});
    return false;
  }
  // What could not be read is told once, until it is read anew; edits show on the picture that stays.
  if (read->error && !due.moved && !reread && shown.position == due.position && shown.unreadable) {
    if (picture && (dirty || compare_missing)) return run(picture, {shown.position, ran_tick, false});
    return false;
  }
  const ShownFrame before = shown;
  const bool same_picture = picture && read == picture && !dirty && !compare_missing;
  shown.position = due.position;
  shown.number = frame.number;
  shown.held = frame.held;
  shown.name = footage->picture_name(frame.picture);
  shown.unreadable = read->error;
  if (read->error) {
    reread = false;
    transport.shown(due);
    figures.frame_unreadable(frame.number, *read->error);
    return true;
  }
  const auto may_change = [](LiveSession* session) {
    Stack* stack = session ? session->live().stack() : nullptr;
    return stack && (stack->preset().may_change() || has_histories(session));
  };
  const bool moves = may_change(first.get()) || may_change(second.get());
  if (same_picture && !moves) {
    reread = false;
    transport.shown(due);
    ++figures.kept;
    figures.frame_shown(now, 0, transport.playing());
    return true;
  }
  AFTERGLOW_TRY(const bool changed, run(read, due));
  transport.shown(due);
  if (!changed) {  // it is being built: what is on screen stays
    if (transport.playing() && due.moved) ++figures.rebuilding;
    shown = before;
    return false;
  }
  reread = false;
  return true;
}

/// One at a time, so that no frame is held up for long.
Result<bool> Player::State::time_a_kernel(bool changed, Step& step) {
  if (!time_kernels || !picture) return false;
  constexpr int kEvery = 6;  // frames while playing: a kernel that is timed is one that runs twice
  if (transport.playing()) {
    if (changed && first->times().kernels_run > 0) ++frames_untimed;
    if (frames_untimed < kEvery) return false;
  } else if (changed || first->all_timed()) {
    if (!first->all_timed()) step.next = now();
    return false;
  }
  frames_untimed = 0;
  AFTERGLOW_TRY(const bool timed, first->time_a_kernel());
  if (timed && !transport.playing() && !first->all_timed()) step.next = now();
  return timed;
}

FrameState Player::frame_state(int position) const {
  const FootageFrame& frame = state_->footage->frame(position);
  {
    const std::lock_guard lock(state_->mutex);
    if (state_->unreadable.contains(frame.picture)) return FrameState::unreadable;
  }
  if (frame.held) return FrameState::missing;
  return state_->ahead->has(frame.picture) ? FrameState::cached : FrameState::unread;
}

Result<Step> Player::step() {
  State& s = *state_;
  const double now = s.now();
  {
    const std::lock_guard lock(s.mutex);
    s.awake = false;
  }
  Step step;
  s.take_builds();
  s.take_footage();
  s.tell_errors();
  step.reloaded = std::exchange(s.reloaded, false);
  if (!s.transport.playing()) s.figures.stop();
  if (s.sound) s.sound_follower.follow(s.transport, *s.footage, *s.sound, now);
  AFTERGLOW_TRY(step.changed, s.show_due(now));
  s.watch_finite();
  step.told = s.take_finite();
  step.next = s.transport.next_due();
  AFTERGLOW_TRY(step.timed, s.time_a_kernel(step.changed, step));
  s.turn_ended = s.now();
  return step;
}

void Player::wait(double until) {
  State& s = *state_;
  std::unique_lock lock(s.mutex);
  constexpr double kLongest = 0.25;  // seconds: whoever waits looks at signals too
  const double seconds = std::clamp(until - s.now(), 0.0, kLongest);
  s.woken.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return s.awake; });
}

void Player::settle() {
  State& s = *state_;
  s.first->live().settle();
  if (s.second) s.second->live().settle();
  s.take_builds();
  const Transport::Due due = s.transport.due(s.now());
  s.want_pictures();
  s.ahead->wait(s.footage->frame(due.position).picture);
}

Result<std::unique_ptr<Player>> Player::open(Device& device, const PlayerOptions& options, Diagnostics& diagnostics) {
  auto state = std::make_unique<State>(device, options, diagnostics);
  State& s = *state;
  if (!s.options.clock) s.options.clock = steady_seconds;
  AFTERGLOW_CHECK(s.open_row(options.footage));
  const std::vector<Override> overrides = options.live.stack.preset.overrides;
  AFTERGLOW_TRY(s.first, LiveSession::open(device, options.preset, s.live_options(overrides), diagnostics));
  if (!options.other_preset.empty()) {
    AFTERGLOW_TRY(s.second, LiveSession::open(device, options.other_preset, s.live_options(overrides), diagnostics));
  }
  s.transport.set_fps(s.usual_fps(), s.now());
  s.transport.set_loop(options.loop, s.now());
  s.transport.set_pacing(options.pacing, s.now());
  if (options.sound)
    s.sound = std::make_unique<Sound>(*options.sound, s.options.clock, [state = &s](const std::string& why) {
      state->diagnostics.warn(why);
      state->wake();
    });
  if (options.finite_watch)
    s.finite_watch =
        std::make_unique<FiniteWatch>(*options.finite_watch, options.live.stack, [state = &s] { state->wake(); });
  if (!options.show.empty()) s.first->live().show(options.show);
  s.follow_needs();
  s.begin_reading();
  s.want_pictures();
  return std::unique_ptr<Player>(new Player(std::move(state)));
}

Player::Player(std::unique_ptr<State> state) : state_(std::move(state)) {}
Player::~Player() = default;

double Player::now() const { return state_->now(); }
Transport& Player::transport() { return state_->transport; }
View& Player::view() { return state_->view; }
const std::filesystem::path& Player::preset_file() const { return state_->options.preset; }
const std::filesystem::path& Player::other_file() const { return state_->options.other_preset; }
const Footage& Player::footage() const { return *state_->footage; }
const FootageOptions& Player::footage_options() const { return state_->options.footage; }
Sound* Player::sound() { return state_->sound.get(); }
LiveStack& Player::live() { return state_->first->live(); }
LiveStack* Player::other() { return state_->second ? &state_->second->live() : nullptr; }
const ShownFrame& Player::shown() const { return state_->shown; }
const LiveSession& Player::session() const { return *state_->first; }

}  // namespace afterglow
