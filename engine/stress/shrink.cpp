// SPDX-License-Identifier: MIT
#include "stress/shrink.h"

#include <algorithm>

#include "stress/pictures.h"

namespace afterglow::stress {
namespace {

Picture cropped_picture(const Picture& picture, const Rect& part) {
  Picture out = changed(picture);
  out.color = cropped(picture.color, part);
  for (auto& [name, image] : out.auxiliary) image = cropped(image, part);
  out.data_window = out.display_window = {0, 0, part.width, part.height};
  return out;
}

bool is_black(const Image& image, const Rect& part) {
  for (int y = part.y; y < part.y + part.height; ++y)
    for (int x = part.x; x < part.x + part.width; ++x)
      if (std::any_of(image.at(x, y), image.at(x, y) + 3, [](float v) { return v != 0; })) return false;
  return true;
}

class Shrinker {
 public:
  Shrinker(Situation situation, const StillFails& fails, int most_tries)
      : situation_(std::move(situation)), fails_(fails), left_(most_tries), most_(most_tries) {}

  Shrunk run() {
    bool smaller = true;
    while (smaller && left_ > 0) {
      smaller = leave_out_entries();
      smaller |= reset_settings();
      smaller |= cut();
      smaller |= blacken();
    }
    return {std::move(situation_), most_ - left_};
  }

 private:
  /// Takes the candidate when it still fails.
  bool take(Situation candidate) {
    if (left_ <= 0) return false;
    --left_;
    if (!fails_(candidate)) return false;
    situation_ = std::move(candidate);
    return true;
  }

  bool leave_out_entries() {
    bool any = false;
    for (std::size_t i = situation_.look.entries.size(); i-- > 0 && situation_.look.entries.size() > 1;) {
      Situation candidate = situation_;
      candidate.look = situation_.look.without(i);
      any |= take(std::move(candidate));
    }
    return any;
  }

  bool reset_settings() {
    bool any = false;
    for (std::size_t e = 0; e < situation_.look.entries.size(); ++e)
      for (std::size_t i = situation_.look.entries[e].composition.size(); i-- > 0;) {
        Situation candidate = situation_;
        auto& composition = candidate.look.entries[e].composition;
        composition.erase(composition.begin() + static_cast<std::ptrdiff_t>(i));
        any |= take(std::move(candidate));
      }
    for (std::size_t e = 0; e < situation_.look.entries.size(); ++e)
      for (std::size_t i = situation_.look.entries[e].settings.size(); i-- > 0;) {
        Situation candidate = situation_;
        auto& settings = candidate.look.entries[e].settings;
        settings.erase(settings.begin() + static_cast<std::ptrdiff_t>(i));
        any |= take(std::move(candidate));
      }
    return any;
  }

  /// Halves first, then quarters, … a row or column at last.
  bool cut() {
    bool any = false;
    for (const bool across : {true, false})
      for (int share = 2; left_ > 0;) {
        const Size size = situation_.picture.color.size();
        const int length = across ? size.width : size.height;
        const int off = std::max(1, length / share);
        if (length < 2) break;
        const auto without = [&](int from) {
          Situation candidate = situation_;
          candidate.picture = cropped_picture(situation_.picture, across ? Rect{from, 0, length - off, size.height}
                                                                         : Rect{0, from, size.width, length - off});
          return take(std::move(candidate));
        };
        if (without(0) || without(off)) {
          any = true;
        } else if (off == 1) {
          break;
        } else {
          share *= 2;
        }
      }
    return any;
  }

  bool blacken() {
    const Size size = situation_.picture.color.size();
    return blacken({0, 0, size.width, size.height});
  }
  /// All of the part, or else each of its halves.
  bool blacken(const Rect& part) {
    if (left_ <= 0 || is_black(situation_.picture.color, part)) return false;
    Situation candidate = situation_;
    candidate.picture.content.clear();
    for (int y = part.y; y < part.y + part.height; ++y)
      for (int x = part.x; x < part.x + part.width; ++x) std::fill_n(candidate.picture.color.at(x, y), 3, 0.0f);
    if (take(std::move(candidate))) return true;
    if (part.width <= 1 && part.height <= 1) return false;
    if (part.width >= part.height) {
      const int half = part.width / 2;
      const bool left = blacken({part.x, part.y, half, part.height});
      return blacken({part.x + half, part.y, part.width - half, part.height}) || left;
    }
    const int half = part.height / 2;
    const bool upper = blacken({part.x, part.y, part.width, half});
    return blacken({part.x, part.y + half, part.width, part.height - half}) || upper;
  }

  Situation situation_;
  const StillFails& fails_;
  int left_, most_;
};

}  // namespace

Shrunk shrink(Situation situation, const StillFails& fails, int most_tries) {
  return Shrinker(std::move(situation), fails, most_tries).run();
}

}  // namespace afterglow::stress
