// SPDX-License-Identifier: MIT
// Footage that grows and changes while it is played.
#include "image/sequence.h"
#include "play/player_state.h"

namespace afterglow {

FootageNeeds Player::State::needs_now() {
  const std::lock_guard lock(mutex);
  return needs;
}

/// What that reader reads of; null: it is of footage before.
std::shared_ptr<const Footage> Player::State::readable(std::uint64_t reader) {
  const std::lock_guard lock(mutex);
  return reader == readers ? read_footage : nullptr;
}

/// `footage`, with the transport at its first frame, or at the one that was asked for.
Result<void> Player::State::open_row(FootageOptions wanted) {
  std::optional<SequenceFrame> around;
  if (wanted.whole_sequences && wanted.inputs.size() == 1 && wanted.frames.empty())
    around = sequence_around(wanted.inputs.front());
  if (around) wanted.inputs.front() = around->pattern;
  AFTERGLOW_TRY(footage, Footage::open(wanted, diagnostics));
  options.footage = std::move(wanted);
  shots = ShotWatch(options.footage.cuts);
  transport.set_frames(footage->frames());
  for (int position = 0; around && position < footage->frames(); ++position)
    if (footage->frame(position).number == around->frame) transport.go_to(position, now());
  return {};
}

namespace {

/// Where the frame at a position of the older footage is in the newer one. None: it is gone.
std::optional<int> moved(const Footage& older, int position, const Footage& newer) {
  const auto clip_of = [](const Footage& footage, int at) -> const std::string& {
    return footage.clips()[static_cast<std::size_t>(footage.clip_at(at))].key;
  };
  const auto is_it = [&](int at) {
    return newer.frame(at).number == older.frame(position).number && clip_of(newer, at) == clip_of(older, position);
  };
  if (position < newer.frames() && is_it(position)) return position;
  for (int at = 0; at < newer.frames(); ++at)
    if (is_it(at)) return at;
  return std::nullopt;
}

}  // namespace

/// Pictures keep their numbers: what is in memory stays there.
void Player::State::take_footage() {
  const auto newer = rendering ? rendering->take() : nullptr;
  if (!newer) return;
  const auto older = footage;
  footage = newer;
  {
    const std::lock_guard lock(mutex);
    read_footage = newer;
  }
  const int asked = transport.position();
  transport.resize(footage->frames(), now());
  // The frames that are asked for and shown stay, though others may have come before them.
  if (const auto at = moved(*older, asked, *footage); at && *at != transport.position()) transport.go_to(*at, now());
  if (shown.position >= 0) shown.position = moved(*older, shown.position, *footage).value_or(-1);
  wanted_for.clear();
  reread = true;
}

std::shared_ptr<const Picture> Player::source() const {
  const auto& read = state_->picture;
  return read ? std::shared_ptr<const Picture>(read, &read->picture) : nullptr;
}

}  // namespace afterglow
