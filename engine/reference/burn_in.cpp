// SPDX-License-Identifier: MIT
#include "reference/burn_in.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <optional>

#include "core/paths.h"
#include "image/reader.h"

namespace afterglow::reference {
namespace {

constexpr int kWidth = 24, kHeight = 48, kAcross = 32;  // of a letter in the font, letters in a row of it
constexpr double kSpread = 6;                           // texels

/// Where a letter stands in the font; what it lacks is a square.
int place_of(char32_t letter) {
  constexpr char32_t kRanges[][2] = {{0x20, 0x7E},     {0xA0, 0x17F},    {0x384, 0x3CE},   {0x400, 0x45F},
                                     {0x2010, 0x2015}, {0x2018, 0x201E}, {0x2020, 0x2022}, {0x2026, 0x2026},
                                     {0x20AC, 0x20AC}, {0x2122, 0x2122}, {0x2190, 0x2193}, {0x25A1, 0x25A1},
                                     {0x25CF, 0x25CF}};
  int place = 0;
  for (const auto& [first, last] : kRanges) {
    if (letter >= first && letter <= last) return place + static_cast<int>(letter - first);
    place += static_cast<int>(last - first) + 1;
  }
  return place_of(0x25A1);
}

/// Nothing where it cannot be read.
const DoubleImage& font() {
  static const DoubleImage image = [] {
    Diagnostics quiet;
    const auto picture = read_picture(find_installation() / "assets/fonts/mono.exr", {}, quiet);
    return picture ? from_floats(picture->color.pixels.data(), picture->color.size(), picture->color.channels)
                   : DoubleImage(1, 1);
  }();
  return image;
}

std::vector<std::u32string> lines_of(const std::u32string& text) {
  std::vector<std::u32string> lines(1);
  for (const char32_t letter : text)
    if (letter == U'\n')
      lines.emplace_back();
    else
      lines.back() += letter;
  return lines;
}

class Label {
 public:
  Label(const Size& size, const DoubleImage& font, const BurnIn& s) : font_(font), s_(s), lines_(lines_of(s.text)) {
    std::size_t columns = 1;
    for (const auto& line : lines_) columns = std::max(columns, line.size());
    columns_ = static_cast<int>(columns);
    const double across = (columns_ + 1) / 2.0, down = static_cast<double>(lines_.size()) + 0.2;
    const double left = glm::min(s.margin * size.height, size.width / 4.0);
    const double top = glm::min(s.margin * size.height, size.height / 4.0);
    line_ = glm::min(s.size * size.height, glm::min((size.width - 2 * left) / across, (size.height - 2 * top) / down));
    box_ = glm::dvec2(across, down) * line_;
    corner_ = glm::dvec2(left, top) +
              glm::dvec2(s.x, s.y) * (glm::dvec2(size.width - 2 * left, size.height - 2 * top) - box_);
  }

  /// What lies over a pixel, its colour times how much it covers.
  Rgba at(int x, int y) const {
    const auto shared = [](double pixel, double from, double length) {
      return glm::clamp(glm::min(pixel + 1, from + length) - glm::max(pixel, from), 0.0, 1.0);
    };
    const double boxed = s_.box * shared(x, corner_.x, box_.x) * shared(y, corner_.y, box_.y);
    const int reads = glm::clamp(static_cast<int>(std::ceil(kHeight / line_)), 1, 4);
    double letter = 0, outlined = 0;
    for (int j = 0; j < reads; ++j)
      for (int i = 0; i < reads; ++i) {
        const glm::dvec2 at(x + (i + 0.5) / reads, y + (j + 0.5) / reads);
        const double inside = within((at - corner_) / line_ - glm::dvec2(0.25, 0.1));
        const double slope = glm::max(line_ * reads, kHeight / 2.0);
        const auto cover = [&](double by) { return glm::clamp((inside + by) * slope + 0.5, 0.0, 1.0); };
        letter += cover(0) / (reads * reads);
        outlined += cover(s_.outline) / (reads * reads);
      }
    const double covered = outlined + boxed * (1 - outlined);
    return Rgba(s_.color * letter + s_.background * (covered - letter), covered);
  }

 private:
  /// How far a place is within a letter of the text; both in heights of a line.
  double within(glm::dvec2 at) const {
    const int row = static_cast<int>(std::floor(at.y)), column = static_cast<int>(std::floor(at.x * 2));
    double best = -kSpread / kHeight;
    for (int beside = column - 1; beside <= column + 1; ++beside)
      for (int line = row - 1; line <= row + 1; ++line) {
        const auto place = letter_at(beside, line);
        if (!place) continue;
        const glm::dvec2 from = (at - glm::dvec2(beside * 0.5, line)) * double{kHeight};
        const glm::dvec2 near = glm::clamp(from, glm::dvec2(0.5), glm::dvec2(kWidth, kHeight) - 0.5);
        const glm::dvec2 corner(*place % kAcross * kWidth, *place / kAcross * kHeight);
        const double value = sample_linear(font_, corner.x + near.x, corner.y + near.y).r;
        best = glm::max(best, ((2 * value - 1) * kSpread - glm::length(from - near)) / kHeight);
      }
    return best;
  }

  std::optional<int> letter_at(int column, int row) const {
    if (row < 0 || row >= static_cast<int>(lines_.size()) || column < 0 || column >= columns_) return {};
    const auto& line = lines_[static_cast<std::size_t>(row)];
    const int before = static_cast<int>(std::floor((columns_ - static_cast<int>(line.size())) * s_.x + 0.5));
    const int at = column - before;
    return place_of(at < 0 || at >= static_cast<int>(line.size()) ? U' ' : line[static_cast<std::size_t>(at)]);
  }

  const DoubleImage& font_;
  const BurnIn& s_;
  std::vector<std::u32string> lines_;
  int columns_ = 1;
  double line_ = 0;
  glm::dvec2 box_{0}, corner_{0};
};

}  // namespace

DoubleImage burn_in(const DoubleImage& source, const BurnIn& s) {
  const Label label(source.size(), font(), s);
  return generate(source.size(), [&](int x, int y) {
    const Rgba over = label.at(x, y);
    const Rgba& p = source.at(x, y);
    return Rgba(Rgb(over) + Rgb(p) * (1 - over.a), p.a);
  });
}

}  // namespace afterglow::reference
