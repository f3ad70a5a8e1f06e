// SPDX-License-Identifier: MIT
#include "play/shot_watch.h"

namespace afterglow {

bool ShotWatch::begins(const Footage& footage, int position, const Picture& picture) {
  const FootageFrame& frame = footage.frame(position);
  const Footage::Clip& clip = footage.clips()[static_cast<std::size_t>(footage.clip_at(position))];
  Frame asked{.clip = clip.key, .place = frame.number, .number = frame.number};
  const bool looks = cuts_.looks(footage.movie(frame.picture) != nullptr);
  if (looks) asked.sketch = sketch_of(picture);
  const bool blank = asked.sketch.blank;
  if (!shown_) {
    asked.begins = false;
  } else if (shown_->clip != clip.key) {
    asked.begins = true;
  } else if (shown_->place == frame.number) {
    asked.number = shown_->number;
    asked.begins = shown_->begins;
  } else if (frame.held) {
    asked.number = shown_->number;
  } else {
    const ShotSketch& before = shown_->sketch;
    asked.begins = cuts_.between(shown_->number, frame.number) ||
                   (looks && !blank && (before.blank || !same_shot(before, asked.sketch)));
  }
  if (blank && shown_ && !asked.begins) asked.sketch = shown_->sketch;
  asked_ = std::move(asked);
  return asked_->begins;
}

}  // namespace afterglow
