// SPDX-License-Identifier: MIT
// What a player tells of values that are not finite.
#include <fmt/format.h>

#include <utility>

#include "image/metadata.h"
#include "play/player.h"
#include "play/player_state.h"

namespace afterglow {

/// The first frame of each build is looked at, and each that stands still.
void Player::State::watch_finite() {
  if (!finite_watch || !picture || shown.position < 0 || shown.failed || shown.unreadable) return;
  const std::pair now_shown{measured, shown.position};
  if (measured == 0 || asked_finite == now_shown) return;
  if (transport.playing() && asked_finite && asked_finite->first == measured) return;
  asked_finite = now_shown;
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

/// Each pass is told once, until all is well again.
void Player::State::take_finite() {
  if (!finite_watch) return;
  auto answer = finite_watch->take();
  if (!answer) return;
  if (answer->passes.empty() && !answer->untraced) {
    shown.not_finite.reset();
    told_finite.clear();
    return;
  }
  for (const PassFinding& finding : answer->passes) {
    const std::string where = finding.file.empty() ? "" : fmt::format("{}:{}: ", finding.file, finding.line);
    if (told_finite.insert(where + finding.pass).second)
      diagnostics.warn(fmt::format("{}{}; shown as 0, in {}", where, finding_text(finding), answer->name));
  }
  if (answer->untraced && told_finite.insert("untraced").second)
    diagnostics.warn(fmt::format("{}: {}", answer->name, kUntraced));
  shown.not_finite = std::make_shared<const FiniteAnswer>(*std::move(answer));
}

void Player::finish_finite_watch() {
  State& s = *state_;
  if (!s.finite_watch) return;
  s.watch_finite();
  s.finite_watch->finish();
  s.take_finite();
}

}  // namespace afterglow
