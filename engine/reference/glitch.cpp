// SPDX-License-Identifier: MIT
#include "reference/glitch.h"

#include <algorithm>
#include <cmath>

#include "reference/grain.h"

namespace afterglow::reference {

namespace {

int wrapped(int i, int n) { return ((i % n) + n) % n; }

}  // namespace

DoubleImage glitch(const DoubleImage& source, const Glitch& s) {
  const int width = source.width, height = source.height;
  const auto pixels = [&](double share) { return static_cast<int>(std::floor(share * width + 0.5)); };
  const Words of_frame = pcg3d({0xffffffffu, s.seed, s.frame});
  const int shake = pixels((unit(of_frame[0]) - 0.5) * 0.2 * s.horizontal_shake);
  const int split = pixels((0.5 + 0.5 * unit(of_frame[1])) * 0.04 * s.rgb_split);
  const double turns = s.vertical_roll * s.time;
  const int roll = static_cast<int>(std::floor(height * (turns - std::floor(turns))));
  return generate(source.size(), [&](int x, int y) {
    const Words of_line = pcg3d({static_cast<std::uint32_t>((y + 0.5) / s.line_height), s.seed, s.frame});
    const double random = 2 * unit(of_line[0]) - 1;
    const bool jumps = s.scan_line_jitter > 0 && std::abs(random) >= 1 - 1.2 * s.scan_line_jitter;
    const int shift = shake + (jumps ? pixels(random * (0.002 + 0.05 * std::pow(s.scan_line_jitter, 3))) : 0);
    const auto read = [&](int moved, int channel) {
      const int from = s.stretch ? std::clamp(x + moved, 0, width - 1) : wrapped(x + moved, width);
      return source.at(from, wrapped(y + roll, height))[channel];
    };
    return Rgba(read(shift + split, 0), read(shift, 1), read(shift - split, 2), source.at(x, y).a);
  });
}

}  // namespace afterglow::reference
