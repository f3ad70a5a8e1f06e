// SPDX-License-Identifier: MIT
// Footage that grows and changes while it is played.
#include "play/player_state.h"

namespace afterglow {

std::shared_ptr<const Footage> Player::State::readable() {
  const std::lock_guard lock(mutex);
  return read_footage;
}

/// Pictures keep their numbers: what is in memory stays there.
void Player::State::take_footage() {
  const auto newer = rendering ? rendering->take() : nullptr;
  if (!newer) return;
  const int number = footage->frame(transport.position()).number;
  footage = newer;
  {
    const std::lock_guard lock(mutex);
    read_footage = newer;
  }
  transport.resize(footage->frames(), now());
  // The frame that is shown stays, though others may have come before it.
  for (int position = 0; position < footage->frames(); ++position)
    if (footage->frame(position).number == number && footage->frame(transport.position()).number != number)
      transport.go_to(position, now());
  wanted_for.clear();
  reread = true;
}

std::shared_ptr<const Picture> Player::source() const {
  const auto& read = state_->picture;
  return read ? std::shared_ptr<const Picture>(read, &read->picture) : nullptr;
}

}  // namespace afterglow
