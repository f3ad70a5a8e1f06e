// SPDX-License-Identifier: MIT
#include "play/shot_watch.h"

namespace afterglow {

bool ShotWatch::begins(const Footage& footage, int position, const Picture& picture) {
  const FootageFrame& frame = footage.frame(position);
  const Footage::Clip& clip = footage.clips()[static_cast<std::size_t>(footage.clip_at(position))];
  Frame asked{.clip = clip.key, .number = frame.number};
  const bool looks = cuts_.looks(footage.movie(frame.picture) != nullptr);
  if (looks) asked.sketch = sketch_of(picture);
  if (!shown_) {
    asked.begins = false;
  } else if (shown_->clip != clip.key) {
    asked.begins = true;
  } else if (shown_->number == frame.number) {
    asked.begins = shown_->begins;
  } else {
    asked.begins = cuts_.between(shown_->number, frame.number) || (looks && !same_shot(shown_->sketch, asked.sketch));
  }
  asked_ = std::move(asked);
  return asked_->begins;
}

}  // namespace afterglow
