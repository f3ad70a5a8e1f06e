// SPDX-License-Identifier: MIT
// What a player tells of values that are not finite.
#include <fmt/format.h>

#include <utility>

#include "image/metadata.h"
#include "play/player.h"
#include "play/player_state.h"

namespace afterglow {

/// There is another preset, or other footage.
void Player::State::forget_finite() {
  asked_finite.reset();
  told_finite.clear();
  shown.not_finite.reset();
}

/// The first frame of each build is looked at, and each that stands still.
void Player::State::watch_finite() {
  if (!finite_watch || !picture || shown.position < 0 || shown.failed || shown.unreadable) return;
  if (measured == 0) return;
  const bool same_build = asked_finite && asked_finite->build == measured;
  if (same_build && (transport.playing() || asked_finite->picture.lock() == picture)) return;
  asked_finite = {measured, picture};
  FiniteQuestion question{.preset = options.preset,
                          .text = {},
                          .overrides = first->live().overrides(),
                          .arguments = edits.arguments(options.live.stack.preset.arguments),
                          .picture = picture,
                          .name = shown.name,
                          .context = context(shown.position, picture_proxy)};
  if (const StackText& text = edits.stack_text()) question.text = *text;
  if (picture->picture.facts) question.context.position = camera_position(picture->picture.facts->metadata);
  finite_watch->ask(std::move(question));
}

/// Each pass is told once, until all is well again. True: what is shown says something else.
bool Player::State::take_finite() {
  if (!finite_watch) return false;
  auto answer = finite_watch->take();
  if (!answer) return false;
  if (answer->passes.empty() && !answer->untraced) {
    told_finite.clear();
    return std::exchange(shown.not_finite, nullptr) != nullptr;
  }
  for (const PassFinding& finding : answer->passes) {
    const std::string where = finding.file.empty() ? "" : fmt::format("{}:{}: ", finding.file, finding.line);
    if (told_finite.insert(where + finding.pass).second)
      diagnostics.warn(fmt::format("{}{}; shown as 0, in {}", where, finding_text(finding), answer->name));
  }
  if (answer->untraced && told_finite.insert("untraced").second)
    diagnostics.warn(fmt::format("{}: {}", answer->name, kUntraced));
  shown.not_finite = std::make_shared<const FiniteAnswer>(*std::move(answer));
  return true;
}

void Player::finish_finite_watch() {
  State& s = *state_;
  if (!s.finite_watch) return;
  s.watch_finite();
  s.finite_watch->finish();
  s.take_finite();
}

}  // namespace afterglow
