// SPDX-License-Identifier: MIT
#include "window/scope_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "window/atlas_cells.h"

namespace afterglow {
namespace {

constexpr int kSide = AtlasCells::kSide;
static_assert(kSide == Scopes::kLevels && kSide == Scopes::kMostColumns && kSide == Scopes::kColors);

using Light = std::array<float, 3>;
constexpr Light kPaper{0.05f, 0.054f, 0.062f};
constexpr Light kInks[] = {{0.92f, 0.30f, 0.27f}, {0.33f, 0.80f, 0.36f}, {0.36f, 0.55f, 1.0f}, {0.80f, 0.82f, 0.85f}};

/// Light is added: what overlaps is brighter.
class Sheet {
 public:
  Sheet() : light_(static_cast<std::size_t>(kSide * kSide), kPaper) {}
  void add(int x, int y, const Light& ink, float part) {
    Light& to = light_[static_cast<std::size_t>(y * kSide + x)];
    for (std::size_t c = 0; c < 3; ++c) to[c] += ink[c] * part;
  }
  std::vector<ImU32> pixels() const {
    std::vector<ImU32> out;
    out.reserve(light_.size());
    const auto code = [](float part) { return static_cast<int>(std::min(part, 1.0f) * 255 + 0.5f); };
    for (const Light& c : light_) out.push_back(IM_COL32(code(c[0]), code(c[1]), code(c[2]), 255));
    return out;
  }

 private:
  std::vector<Light> light_;
};

/// One pixel can be seen, and many do not hide how many they are.
float brightness(std::uint32_t count, double most) {
  return count == 0 ? 0.0f : static_cast<float>(std::min(1.0, 0.25 + 1.2 * std::sqrt(count / std::max(most, 1.0))));
}

void draw_histogram(Sheet& sheet, const Scopes& scopes) {
  // The ends hold all that is beyond them: they do not set the height.
  std::uint32_t most = 1;
  for (int c = 0; c < 3; ++c)
    for (int i = 1; i + 1 < Scopes::kLevels; ++i)
      most = std::max(most, scopes.histogram[static_cast<std::size_t>(c)][static_cast<std::size_t>(i)]);
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < Scopes::kLevels; ++i) {
      const double part = scopes.histogram[static_cast<std::size_t>(c)][static_cast<std::size_t>(i)];
      const int height = static_cast<int>(std::ceil(std::min(1.0, part / most) * kSide));
      for (int y = kSide - height; y < kSide; ++y) sheet.add(i, y, kInks[c], 0.62f);
    }
  }
}

/// One channel from `left` on, in `width` pixels.
void draw_waveform(Sheet& sheet, const Scopes& scopes, int channel, int left, int width) {
  if (scopes.columns == 0) return;
  const double most = static_cast<double>(scopes.pixels) / scopes.columns / 4;
  for (int x = 0; x < width; ++x) {
    const int first = x * scopes.columns / width, last = std::max((x + 1) * scopes.columns / width, first + 1);
    for (int level = 0; level < Scopes::kLevels; ++level) {
      std::uint32_t count = 0;
      for (int column = first; column < last; ++column) count += scopes.at(channel, column, level);
      sheet.add(left + x, kSide - 1 - level, kInks[channel], brightness(count, most * (last - first)));
    }
  }
}

void draw_vectorscope(Sheet& sheet, const Scopes& scopes) {
  const double most = static_cast<double>(scopes.pixels) / 400;
  for (int cr = 0; cr < kSide; ++cr) {
    for (int cb = 0; cb < kSide; ++cb) {
      const std::uint32_t count = scopes.color_at(cb, cr);
      if (count == 0) continue;
      const float u = (static_cast<float>(cb) + 0.5f) / kSide - 0.5f,
                  v = (static_cast<float>(cr) + 0.5f) / kSide - 0.5f;
      const Light color{0.62f + 1.5748f * v, 0.62f - 0.1873f * u - 0.4681f * v, 0.62f + 1.8556f * u};
      Light ink{};
      for (std::size_t c = 0; c < 3; ++c) ink[c] = std::clamp(color[c], 0.12f, 1.0f);
      sheet.add(cb, kSide - 1 - cr, ink, brightness(count, most));
    }
  }
}

}  // namespace

std::vector<ImU32> scope_picture(const Scopes& scopes, ScopeKind kind) {
  Sheet sheet;
  switch (kind) {
    case ScopeKind::histogram:
      draw_histogram(sheet, scopes);
      break;
    case ScopeKind::waveform:
      draw_waveform(sheet, scopes, Scopes::kLuminance, 0, kSide);
      break;
    case ScopeKind::parade:
      for (int c = 0; c < 3; ++c) draw_waveform(sheet, scopes, c, c * 86, 84);  // two pixels between them
      break;
    case ScopeKind::vectorscope:
      draw_vectorscope(sheet, scopes);
      break;
    default:
      break;
  }
  return sheet.pixels();
}

}  // namespace afterglow
