// SPDX-License-Identifier: MIT
#include "image/shot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/glm.hpp>

#include "image/encode.h"

namespace afterglow {
namespace {

constexpr int kWide = 64, kHigh = 36;  // cells of details; tones have half of them on each side
constexpr int kTonesWide = kWide / 2, kTonesHigh = kHigh / 2;
constexpr int kSamples = 8;         // at most, of a cell on each side
constexpr float kBrightest = 1000;  // that a cell counts for, ÷ the geometric mean: a spark is no picture
constexpr float kDark = 0.02f;      // of the mean, which is added before the logarithm
constexpr float kDarkest = 1e-6f;   // the same where there is no light
constexpr float kBar = 0.01f, kBarNoise = 2e-4f;  // of the mean, and beside it, is what a black bar has at most
constexpr int kBarEdge = 3;                       // cells beside it: a part of one, and two whose details see it
constexpr double kBlank = 0.2;                    // stops by which what shows nothing varies
constexpr double kOtherLevel = 1;                 // stops; with other details it is another place
constexpr double kToneNoise = 0.05, kDetailNoise = 0.02;  // stops
constexpr double kTonesAlike = 0.75, kDetailsAlike = 0.4;

using Cells = std::vector<glm::vec3>;

/// Where the samples of a cell lie along a side of that many pixels.
struct Samples {
  int first, count, step;
};

Samples samples_of(int cell, int cells, int pixels) {
  const auto begin = static_cast<int>(static_cast<long long>(cell) * pixels / cells);
  const auto end = std::max(static_cast<int>(static_cast<long long>(cell + 1) * pixels / cells), begin + 1);
  const int step = (end - begin + kSamples - 1) / kSamples;
  return {begin + (end - begin - 1) % step / 2, (end - begin + step - 1) / step, step};
}

/// Means of cells.
Cells cells_of(const Picture& picture) {
  const Image& color = picture.color;
  Cells out(kWide * kHigh, glm::vec3(0));
  std::vector<float> memory;
  for (int y = 0; y < kHigh; ++y) {
    const Samples rows = samples_of(y, kHigh, color.height);
    glm::vec3* cells = out.data() + y * kWide;
    for (int i = 0; i < rows.count; ++i) {
      const float* row = color_row(picture, rows.first + i * rows.step, memory);
      for (int x = 0; x < kWide; ++x) {
        const Samples columns = samples_of(x, kWide, color.width);
        glm::vec3 sum(0);
        for (int j = 0; j < columns.count; ++j) {
          const float* pixel = row + static_cast<std::size_t>(columns.first + j * columns.step) * 4;
          sum += glm::max(glm::vec3(pixel[0], pixel[1], pixel[2]), 0.f);
        }
        cells[x] += sum / static_cast<float>(columns.count * rows.count);
      }
    }
  }
  return out;
}

float brightness(const glm::vec3& color) { return glm::dot(color, glm::vec3(0.2126f, 0.7152f, 0.0722f)); }

float mean_brightness(const Cells& cells) {
  double sum = 0;
  for (const glm::vec3& cell : cells) sum += brightness(cell);
  return static_cast<float>(sum / static_cast<double>(cells.size()));
}

void hold_sparks(Cells& cells) {
  double logarithms = 0;
  for (const glm::vec3& cell : cells) logarithms += std::log2(brightness(cell) + kDarkest);
  const float most = kBrightest * std::exp2(static_cast<float>(logarithms / static_cast<double>(cells.size())));
  for (glm::vec3& cell : cells) cell = glm::min(cell, most);
}

std::vector<float> tones_of(const Cells& cells) {
  Cells tones(kTonesWide * kTonesHigh);
  double sum = 0;
  for (int y = 0; y < kTonesHigh; ++y)
    for (int x = 0; x < kTonesWide; ++x) {
      const glm::vec3* above = cells.data() + 2 * y * kWide + 2 * x;
      const glm::vec3 tone = (above[0] + above[1] + above[kWide] + above[kWide + 1]) / 4.f;
      tones[static_cast<std::size_t>(y * kTonesWide + x)] = tone;
      sum += (tone.r + tone.g + tone.b) / 3;
    }
  const float dark = kDark * static_cast<float>(sum / static_cast<double>(tones.size())) + kDarkest;
  std::vector<float> out;
  out.reserve(3 * tones.size());
  for (int channel = 0; channel < 3; ++channel)
    for (const glm::vec3& tone : tones) out.push_back(std::log2(tone[channel] + dark));
  return out;
}

/// Light that is spread over several cells goes with what is subtracted.
std::vector<float> details_of(const Cells& cells) {
  std::vector<float> stops;
  const float dark = kDark * mean_brightness(cells) + kDarkest;
  for (const glm::vec3& cell : cells) stops.push_back(std::log2(brightness(cell) + dark));
  std::vector<float> out;
  for (int y = 0; y < kHigh; ++y)
    for (int x = 0; x < kWide; ++x) {
      constexpr int kAround = 2;
      float around = 0;
      for (int v = -kAround; v <= kAround; ++v)
        for (int u = -kAround; u <= kAround; ++u)
          around += stops[static_cast<std::size_t>(std::clamp(y + v, 0, kHigh - 1) * kWide +
                                                   std::clamp(x + u, 0, kWide - 1))];
      constexpr float kCells = (2 * kAround + 1) * (2 * kAround + 1);
      out.push_back(std::clamp(stops[static_cast<std::size_t>(y * kWide + x)] - around / kCells, -1.f, 1.f));
    }
  return out;
}

/// What lies within the bars of both.
ShotSketch::Bars common(const ShotSketch::Bars& a, const ShotSketch::Bars& b) {
  return {std::min(a.left, b.left), std::min(a.right, b.right), std::min(a.top, b.top), std::min(a.bottom, b.bottom)};
}

ShotSketch::Bars bars_of(const Cells& cells) {
  const float most = kBar * mean_brightness(cells) + kBarNoise;
  const auto dark = [&](int x, int y) { return brightness(cells[static_cast<std::size_t>(y * kWide + x)]) < most; };
  const auto row = [&](int y) {
    for (int x = 0; x < kWide; ++x)
      if (!dark(x, y)) return false;
    return true;
  };
  const auto column = [&](int x) {
    for (int y = 0; y < kHigh; ++y)
      if (!dark(x, y)) return false;
    return true;
  };
  constexpr int kWidest = kWide / 4, kHighest = kHigh / 4;
  ShotSketch::Bars out;
  while (out.left < kWidest && column(out.left)) ++out.left;
  while (out.right < kWidest && column(kWide - 1 - out.right)) ++out.right;
  while (out.top < kHighest && row(out.top)) ++out.top;
  while (out.bottom < kHighest && row(kHigh - 1 - out.bottom)) ++out.bottom;
  for (int* bar : {&out.left, &out.right, &out.top, &out.bottom})
    if (*bar > 0) *bar += kBarEdge;
  return out;
}

/// Of what two sketches share when one is moved.
struct Shared {
  double first = 0, second = 0, first_squares = 0, second_squares = 0, products = 0;
  double count = 0;

  void add(const float* a, const float* b, int length) {
    for (int i = 0; i < length; ++i) {
      const double p = a[i], q = b[i];
      first += p;
      second += q;
      first_squares += p * p;
      second_squares += q * q;
      products += p * q;
    }
    count += length;
  }
  /// From their means on.
  void center() {
    first_squares -= first * first / count;
    second_squares -= second * second / count;
    products -= first * second / count;
  }
};

struct Plane {
  int wide, high, channels;
  int shift_x, shift_y;  ///< that one may be moved against the other, at most
  bool centered;         ///< each channel from its mean on
  double noise;          ///< added to all variances, so that what is flat is alike
};
constexpr Plane kTones{kTonesWide, kTonesHigh, 3, kTonesWide / 4, kTonesHigh / 4 + 1, true, kToneNoise};
constexpr Plane kDetails{kWide, kHigh, 1, kWide / 4, kHigh / 4, false, kDetailNoise};

/// Where neither has bars, in cells of the plane.
struct Inside {
  int left, right, top, bottom;  ///< the latter of each beyond it
};

Inside inside_of(const Plane& plane, const ShotSketch::Bars& bars) {
  const int part = kWide / plane.wide;
  const auto cells = [part](int fine) { return (fine + part - 1) / part; };
  return {cells(bars.left), plane.wide - cells(bars.right), cells(bars.top), plane.high - cells(bars.bottom)};
}

/// Correlation of what they share when the second is moved by (x, y).
double correlation(const std::vector<float>& a, const std::vector<float>& b, const Plane& plane, const Inside& inside,
                   int x, int y) {
  const int left = inside.left + std::max(x, 0), length = inside.right + std::min(x, 0) - left;
  double products = 0, first = 0, second = 0, count = 0;
  for (int channel = 0; channel < plane.channels; ++channel) {
    Shared shared;
    for (int row = inside.top + std::max(y, 0); row < inside.bottom + std::min(y, 0); ++row) {
      const auto line = [&](int of, int from) {
        return static_cast<std::size_t>((channel * plane.high + of) * plane.wide + from);
      };
      shared.add(a.data() + line(row, left), b.data() + line(row - y, left - x), length);
    }
    if (plane.centered) shared.center();
    products += shared.products;
    first += shared.first_squares;
    second += shared.second_squares;
    count += shared.count;
  }
  const double noise = plane.noise * plane.noise * count;
  return (products + noise) / std::sqrt((first + noise) * (second + noise));
}

/// Whether they are, moved somehow; not at all is tried first, since most frames follow their shot.
bool alike(const std::vector<float>& a, const std::vector<float>& b, const Plane& plane, const ShotSketch::Bars& bars,
           double least) {
  const Inside inside = inside_of(plane, bars);
  for (int far = 0; far <= plane.shift_x; ++far)
    for (int y = -std::min(far, plane.shift_y); y <= std::min(far, plane.shift_y); ++y)
      for (int x = -far; x <= far; x += std::abs(y) == far || far == 0 ? 1 : 2 * far)
        if (correlation(a, b, plane, inside, x, y) >= least) return true;
  return false;
}

/// Whether the tones of a channel are others by far, on the whole.
bool other_level(const ShotSketch& before, const ShotSketch& now, const Inside& inside) {
  for (int channel = 0; channel < kTones.channels; ++channel) {
    double sum = 0, count = 0;
    for (int row = inside.top; row < inside.bottom; ++row)
      for (int x = inside.left; x < inside.right; ++x) {
        const auto at = static_cast<std::size_t>((channel * kTonesHigh + row) * kTonesWide + x);
        sum += now.tones[at] - before.tones[at];
        ++count;
      }
    if (std::abs(sum) > kOtherLevel * count) return true;
  }
  return false;
}

/// By how much the numbers of a plane vary within the bars, root mean square.
double variation(const std::vector<float>& numbers, const Plane& plane, const ShotSketch::Bars& bars) {
  const Inside inside = inside_of(plane, bars);
  double squares = 0, count = 0;
  for (int channel = 0; channel < plane.channels; ++channel) {
    Shared one;
    for (int row = inside.top; row < inside.bottom; ++row) {
      const float* from = numbers.data() + (channel * plane.high + row) * plane.wide + inside.left;
      one.add(from, from, inside.right - inside.left);
    }
    if (plane.centered) one.center();
    squares += one.first_squares;
    count += one.count;
  }
  return std::sqrt(std::max(squares, 0.0) / std::max(count, 1.0));
}

}  // namespace

ShotSketch sketch_of(const Picture& picture) {
  if (picture.color.width <= 0 || picture.color.height <= 0) return {};
  Cells cells = cells_of(picture);
  hold_sparks(cells);
  ShotSketch out{.tones = tones_of(cells), .details = details_of(cells), .bars = bars_of(cells)};
  out.blank = variation(out.tones, kTones, out.bars) < kBlank && variation(out.details, kDetails, out.bars) < kBlank;
  return out;
}

bool same_shot(const ShotSketch& before, const ShotSketch& now) {
  const ShotSketch::Bars bars = common(before.bars, now.bars);
  return (!other_level(before, now, inside_of(kTones, bars)) &&
          alike(before.tones, now.tones, kTones, bars, kTonesAlike)) ||
         alike(before.details, now.details, kDetails, bars, kDetailsAlike);
}

}  // namespace afterglow
