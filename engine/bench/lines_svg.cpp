// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "bench/report.h"
#include "core/text.h"

namespace afterglow::bench {
namespace {

constexpr double kWidth = 960, kHeight = 380, kLeft = 64, kRight = 330, kTop = 44, kBottom = 52;
constexpr std::array kColors{"#4477aa", "#228833", "#aa3377", "#ccbb44", "#66ccee", "#ee6677", "#777777", "#995500"};

struct Line {
  std::string name;
  std::vector<std::pair<double, double>> points;
};

std::vector<Line> lines_of(const Report& report) {
  std::vector<Line> lines;
  for (const auto& curve : report.temporal) {
    if (curve.radius <= 0) continue;
    const std::string name = curve.preset + (curve.settings.empty() ? "" : " " + curve.settings);
    auto at = std::ranges::find(lines, name, &Line::name);
    if (at == lines.end()) at = lines.insert(lines.end(), {name, {}});
    at->points.emplace_back(curve.radius, 100 * curve.swing);
  }
  for (auto& line : lines) std::ranges::sort(line.points);
  return lines;
}

}  // namespace

std::string temporal_svg(const Report& report) {
  const std::vector<Line> lines = lines_of(report);
  double least = 1e30, most = 0, highest = 1;
  for (const auto& line : lines)
    for (const auto& [x, y] : line.points) {
      least = std::min(least, x);
      most = std::max(most, x);
      highest = std::max(highest, y);
    }
  if (lines.empty() || least == most) least = 0.5, most = 4;
  const auto across = [&](double x) {
    return kLeft + (std::log2(x) - std::log2(least)) / (std::log2(most) - std::log2(least)) * (kWidth - kRight - kLeft);
  };
  const auto up = [&](double y) { return kHeight - kBottom - y / highest * (kHeight - kBottom - kTop); };
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n"
      "<text x=\"{2}\" y=\"18\" font-size=\"14\">A highlight that drifts by parts of a pixel: how far the light around "
      "it "
      "swings</text>\n<text x=\"{2}\" y=\"34\" fill=\"#666\">largest less smallest, % of the mean; {3}</text>\n",
      kWidth, kHeight, kLeft, markup_text(report.device));
  for (double x = least; x <= most * 1.001; x *= 2)
    out += fmt::format(
        "<path d=\"M{0:.1f} {1}V{2}\" stroke=\"#ddd\"/><text x=\"{0:.1f}\" y=\"{3}\" "
        "text-anchor=\"middle\">{4:g}</text>\n",
        across(x), kTop, kHeight - kBottom, kHeight - kBottom + 16, x);
  for (int i = 0; i <= 4; ++i)
    out += fmt::format(
        "<path d=\"M{1} {0:.1f}H{2}\" stroke=\"#ddd\"/><text x=\"{3}\" y=\"{4:.1f}\" "
        "text-anchor=\"end\">{5:.3g}</text>\n",
        up(highest * i / 4), kLeft, kWidth - kRight, kLeft - 6, up(highest * i / 4) + 4, highest * i / 4);
  out += fmt::format("<text x=\"{:.0f}\" y=\"{}\" text-anchor=\"middle\">radius of the highlight, pixels</text>\n",
                     (kLeft + kWidth - kRight) / 2, kHeight - 14);
  for (std::size_t n = 0; n < lines.size(); ++n) {
    const char* color = kColors[n % kColors.size()];
    std::string path;
    for (const auto& [x, y] : lines[n].points)
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", across(x), up(y));
    out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n", path, color);
    out += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" font-size=\"10\" fill=\"{}\">{}</text>\n", kWidth - kRight + 14,
                       kTop + 12 + 16.0 * static_cast<double>(n), color, markup_text(lines[n].name));
  }
  return out + "</svg>\n";
}

}  // namespace afterglow::bench
