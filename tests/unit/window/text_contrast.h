// SPDX-License-Identifier: MIT
// How well the words of an interface can be told from what lies under them, from what Dear ImGui wants drawn: the ratio
// of WCAG 2, (L1 + 0.05) / (L2 + 0.05), with relative luminance.
#pragma once

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace afterglow::test {

using Rgb = std::array<double, 3>;  // sRGB codes, 0…1

inline double relative_luminance(const Rgb& rgb) {
  const auto light = [](double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); };
  return 0.2126 * light(rgb[0]) + 0.7152 * light(rgb[1]) + 0.0722 * light(rgb[2]);
}

inline double contrast(const Rgb& a, const Rgb& b) {
  const double la = relative_luminance(a), lb = relative_luminance(b);
  return (std::max(la, lb) + 0.05) / (std::min(la, lb) + 0.05);
}

/// A piece of text that is hard to read.
struct FaintText {
  ImVec2 at;
  Rgb text, ground;
  double ratio = 0;
  std::string words() const {
    const auto code = [](double c) { return std::lround(c * 255); };
    return fmt::format("{:.2f}:1 at {:.0f}, {:.0f}: {} {} {} on {} {} {}", ratio, at.x, at.y, code(text[0]),
                       code(text[1]), code(text[2]), code(ground[0]), code(ground[1]), code(ground[2]));
  }
};

class TextContrast {
 public:
  /// `behind`: what lies under the interface, and in pictures that it shows.
  TextContrast(const ImDrawData& data, const Rgb& behind) : behind_(behind) {
    for (int i = 0; i < data.CmdListsCount; ++i) take(*data.CmdLists[i]);
  }

  /// Where two are under `least`; what rests (is drawn half clear) has another bound.
  std::vector<FaintText> fainter_than(double least, double least_resting) const {
    std::vector<FaintText> out;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      const Triangle& t = all_[i];
      if (t.kind != Kind::glyph) continue;
      const ImVec2 at{(t.at[0].x + t.at[1].x + t.at[2].x) / 3, (t.at[0].y + t.at[1].y + t.at[2].y) / 3};
      if (!inside(t.clip, at)) continue;
      const Rgb ground = ground_at(at, i);
      const double alpha = t.alpha[0];
      Rgb text{};
      for (std::size_t c = 0; c < 3; ++c) text[c] = t.color[0][c] * alpha + ground[c] * (1 - alpha);
      // What is drawn over the words afterwards hides them: that is not theirs to answer for.
      if (alpha < 0.05 || covered(at, i)) continue;
      const double ratio = contrast(text, ground);
      if (ratio < (alpha < 0.95 ? least_resting : least)) out.push_back({at, text, ground, ratio});
    }
    return out;
  }
  std::size_t glyphs() const {
    return static_cast<std::size_t>(
               std::count_if(all_.begin(), all_.end(), [](const Triangle& t) { return t.kind == Kind::glyph; })) /
           2;
  }

 private:
  enum class Kind { plain, glyph, picture };
  struct Triangle {
    Kind kind = Kind::plain;
    bool line = false;  ///< no wider than a stroke of a letter: no ground of one
    ImVec2 at[3];
    Rgb color[3];
    double alpha[3] = {};
    ImVec4 clip, box;
  };

  static bool inside(const ImVec4& box, ImVec2 at) {
    return at.x >= box.x && at.y >= box.y && at.x < box.z && at.y < box.w;
  }
  /// Barycentric; none of them negative: within.
  static std::array<double, 3> weights(const Triangle& t, ImVec2 p) {
    const auto cross = [](ImVec2 a, ImVec2 b, ImVec2 c) {
      return static_cast<double>(b.x - a.x) * (c.y - a.y) - static_cast<double>(b.y - a.y) * (c.x - a.x);
    };
    const double area = cross(t.at[0], t.at[1], t.at[2]);
    if (area == 0) return {-1, -1, -1};
    return {cross(t.at[1], t.at[2], p) / area, cross(t.at[2], t.at[0], p) / area, cross(t.at[0], t.at[1], p) / area};
  }
  static bool reaches(const Triangle& t, ImVec2 at, std::array<double, 3>& w) {
    if (!inside(t.box, at) || !inside(t.clip, at)) return false;
    w = weights(t, at);
    return w[0] >= 0 && w[1] >= 0 && w[2] >= 0;
  }
  Rgb ground_at(ImVec2 at, std::size_t before) const {
    Rgb out = behind_;
    std::array<double, 3> w{};
    for (std::size_t i = 0; i < before; ++i) {
      const Triangle& t = all_[i];
      if (t.kind == Kind::glyph || t.line || !reaches(t, at, w)) continue;
      const double alpha = w[0] * t.alpha[0] + w[1] * t.alpha[1] + w[2] * t.alpha[2];
      for (std::size_t c = 0; c < 3; ++c) {
        const double color =
            t.kind == Kind::picture ? behind_[c] : w[0] * t.color[0][c] + w[1] * t.color[1][c] + w[2] * t.color[2][c];
        out[c] = color * alpha + out[c] * (1 - alpha);
      }
    }
    return out;
  }
  bool covered(ImVec2 at, std::size_t behind) const {
    std::array<double, 3> w{};
    for (std::size_t i = behind + 1; i < all_.size(); ++i) {
      const Triangle& t = all_[i];
      if (t.kind != Kind::glyph && reaches(t, at, w) && w[0] * t.alpha[0] + w[1] * t.alpha[1] + w[2] * t.alpha[2] > 0.3)
        return true;
    }
    return false;
  }

  void take(const ImDrawList& list) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    const ImFontAtlasCustomRect* lines = atlas.GetCustomRectByIndex(atlas.PackIdLines);
    const auto in_lines = [&](ImVec2 uv) {
      const float y = uv.y * static_cast<float>(atlas.TexHeight), x = uv.x * static_cast<float>(atlas.TexWidth);
      return x >= static_cast<float>(lines->X) && x <= static_cast<float>(lines->X + lines->Width) &&
             y >= static_cast<float>(lines->Y) && y <= static_cast<float>(lines->Y + lines->Height);
    };
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback) continue;
      for (unsigned i = command.IdxOffset; i + 2 < command.IdxOffset + command.ElemCount; i += 3) {
        Triangle t;
        ImVec2 uv[3];
        for (unsigned k = 0; k < 3; ++k) {
          const ImDrawVert& vertex =
              list.VtxBuffer[static_cast<int>(command.VtxOffset + list.IdxBuffer[static_cast<int>(i + k)])];
          t.at[k] = vertex.pos;
          uv[k] = vertex.uv;
          const ImVec4 color = ImGui::ColorConvertU32ToFloat4(vertex.col);
          t.color[k] = {color.x, color.y, color.z};
          t.alpha[k] = color.w;
        }
        const bool one = uv[0].x == uv[1].x && uv[0].y == uv[1].y && uv[0].x == uv[2].x && uv[0].y == uv[2].y;
        if (!one && !in_lines(uv[0]))
          t.kind = std::abs(uv[1].x - uv[0].x) * static_cast<float>(atlas.TexWidth) > 100 ? Kind::picture : Kind::glyph;
        t.clip = command.ClipRect;
        t.box = {std::min({t.at[0].x, t.at[1].x, t.at[2].x}), std::min({t.at[0].y, t.at[1].y, t.at[2].y}),
                 std::max({t.at[0].x, t.at[1].x, t.at[2].x}), std::max({t.at[0].y, t.at[1].y, t.at[2].y})};
        t.line = std::min(t.box.z - t.box.x, t.box.w - t.box.y) <= 3.5f;
        t.box.z += 1e-3f;
        t.box.w += 1e-3f;
        all_.push_back(t);
      }
    }
  }

  Rgb behind_;
  std::vector<Triangle> all_;
};

}  // namespace afterglow::test
