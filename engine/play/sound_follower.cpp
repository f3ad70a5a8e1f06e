// SPDX-License-Identifier: MIT
#include "play/sound_follower.h"

#include <cmath>

namespace afterglow {
namespace {

/// Seconds; further apart than this, the sound begins anew where the picture is.
constexpr double kFar = 0.15;
/// What one turn takes away of the distance: sound cards count in blocks, which are not to be seen.
constexpr double kShare = 0.1;
/// Frames by which the transport is elsewhere than its own clock brought it: a seek, the other end of a loop.
constexpr double kMoved = 0.01;

bool sounds(const Transport& transport) {
  return transport.playing() && transport.speed() == 1 && transport.pacing() == Pacing::real_time &&
         transport.heading() > 0;
}

/// What the transport goes around, of the one video that it lies in.
std::optional<SoundLoop> loop_of(const Transport& transport, const Footage& footage) {
  const int first = transport.first(), last = transport.last();
  if (transport.loop() != LoopMode::loop || footage.clip_at(first) != footage.clip_at(last)) return std::nullopt;
  const auto from = sound_moment(footage, first, 0, transport.fps());
  const auto until = sound_moment(footage, last, 1, transport.fps());
  return from && until ? std::optional(SoundLoop{*from, *until}) : std::nullopt;
}

}  // namespace

std::optional<double> sound_moment(const Footage& footage, int position, double fraction, double fps) {
  const Footage::Clip& clip = footage.clips()[static_cast<std::size_t>(footage.clip_at(position))];
  const int last = clip.first + clip.frames - 1;
  if (!(fps > 0) || !footage.frame(clip.first).time || !footage.frame(last).time) return std::nullopt;
  const auto since = [&](int at) {
    int begin = at;  // a frame of a variable rate stays for several turns
    while (begin > clip.first && footage.frame(begin - 1).picture == footage.frame(at).picture) --begin;
    return *footage.frame(at).time + (at - begin) / fps;
  };
  constexpr double kRound = 1.5;  // turns: stamps are rounded
  if (std::abs(since(last) - since(clip.first) - (clip.frames - 1) / fps) > kRound / fps) return std::nullopt;
  return since(position) + fraction / fps;
}

void SoundFollower::follow(Transport& transport, const Footage& footage, Sound& sound, double now) {
  if (transport.pacing() == Pacing::real_time) transport.due(now);
  std::optional<double> moment;
  if (sounds(transport)) moment = sound_moment(footage, transport.position(), transport.fraction(now), transport.fps());
  const auto movie = moment ? footage.movie(footage.frame(transport.position()).picture) : nullptr;
  if (!movie) {
    sound.stop();
    before_.reset();
    return;
  }
  const double place = transport.position() + transport.fraction(now);
  const auto loop = loop_of(transport, footage);
  sound.set_loop(loop);
  const double by = before_ ? place - before_->place - (now - before_->at) * transport.fps() : 0;
  const double around = transport.last() - transport.first() + 1;
  const bool wrapped = loop && std::abs(by + around) <= kMoved;
  const bool moved = !before_ || before_->movie != movie.get() || (std::abs(by) > kMoved && !wrapped);
  const auto heard = moved ? std::nullopt : sound.heard(now);
  double off = heard ? *heard - *moment : 0;
  // One of both may be around the end already.
  if (loop && std::abs(off) > kFar) off = std::remainder(off, loop->until - loop->from);
  if (moved || std::abs(off) > kFar) {
    const int clip = footage.clip_at(transport.position());
    sound.play(footage.clips()[static_cast<std::size_t>(clip)].key, *moment,
               [movie] { return SoundTrack::open(*movie); });
    before_ = {movie.get(), place, now};
    return;
  }
  before_ = {movie.get(), place + transport.nudge(off * kShare, now) * transport.fps(), now};
}

}  // namespace afterglow
