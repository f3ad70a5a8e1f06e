// SPDX-License-Identifier: MIT
// Footage that grows and changes while it is played.
#include "image/sequence.h"
#include "play/player_state.h"

namespace afterglow {

FootageNeeds Player::State::needs_now() {
  const std::lock_guard lock(mutex);
  return needs;
}

std::shared_ptr<const Footage> Player::State::readable() {
  const std::lock_guard lock(mutex);
  return read_footage;
}

/// `footage`, with the transport at its first frame, or at the one that was asked for.
Result<void> Player::State::open_row(FootageOptions wanted) {
  std::optional<SequenceFrame> around;
  if (wanted.whole_sequences && wanted.inputs.size() == 1 && wanted.frames.empty())
    around = sequence_around(wanted.inputs.front());
  if (around) wanted.inputs.front() = around->pattern;
  AFTERGLOW_TRY(footage, Footage::open(wanted, diagnostics));
  options.footage = std::move(wanted);
  transport.set_frames(footage->frames());
  for (int position = 0; around && position < footage->frames(); ++position)
    if (footage->frame(position).number == around->frame) transport.go_to(position, now());
  return {};
}

/// Pictures keep their numbers: what is in memory stays there.
void Player::State::take_footage() {
  const auto newer = rendering ? rendering->take() : nullptr;
  if (!newer) return;
  const int number = footage->frame(transport.position()).number;
  const std::string clip = footage->clips()[static_cast<std::size_t>(footage->clip_at(transport.position()))].key;
  footage = newer;
  {
    const std::lock_guard lock(mutex);
    read_footage = newer;
  }
  transport.resize(footage->frames(), now());
  // The frame that is shown stays, though others may have come before it.
  const auto is_it = [&](int position) {
    return footage->frame(position).number == number &&
           footage->clips()[static_cast<std::size_t>(footage->clip_at(position))].key == clip;
  };
  for (int position = 0; position < footage->frames() && !is_it(transport.position()); ++position)
    if (is_it(position)) transport.go_to(position, now());
  wanted_for.clear();
  reread = true;
}

std::shared_ptr<const Picture> Player::source() const {
  const auto& read = state_->picture;
  return read ? std::shared_ptr<const Picture>(read, &read->picture) : nullptr;
}

}  // namespace afterglow
