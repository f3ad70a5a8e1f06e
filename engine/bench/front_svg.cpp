// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/report.h"
#include "core/text.h"

namespace afterglow::bench {
namespace {

constexpr double kWidth = 960, kHeight = 420, kLeft = 70, kRight = 360, kTop = 44, kBottom = 56;
constexpr double kLeastError = 1e-8;  ///< what is exact stands here on a logarithmic axis

/// A logarithmic axis from pixel `from` to pixel `to` over whole decades, or halves of them where values lie close.
struct LogAxis {
  double low, high, from, to;
  LogAxis(double least, double most, double begin, double end)
      : low(std::floor(std::log10(least) * 2 - 0.2) / 2),
        high(std::ceil(std::log10(most) * 2 + 0.2) / 2),
        from(begin),
        to(end) {}
  double at(double value) const { return from + (std::log10(value) - low) / (high - low) * (to - from); }
  /// 1, 2, 5, 10, … where there are few decades, else powers of ten.
  std::vector<double> ticks() const {
    std::vector<double> out;
    for (int decade = static_cast<int>(std::floor(low)); decade <= high; ++decade)
      for (const double part : {1.0, 2.0, 5.0}) {
        const double value = part * std::pow(10.0, decade), where = std::log10(value);
        if (where >= low - 1e-9 && where <= high + 1e-9 && (part == 1.0 || high - low < 3)) out.push_back(value);
      }
    return out;
  }
};

double error_of(const Point& point) { return std::max(point.quality->error.percentile, kLeastError); }

}  // namespace

std::string front_svg(const Report& report, const Cell& cell) {
  std::vector<const Point*> points;
  for (const auto& point : cell.points)
    if (point.quality && point.execute.median > 0 && std::isfinite(point.quality->error.percentile))
      points.push_back(&point);
  std::ranges::sort(points, {}, [](const Point* p) { return p->execute.median; });
  double fast = cell.copy.median, slow = fast, least = 1, most = kLeastError;
  for (const Point* p : points) {
    fast = std::min(fast, p->execute.median);
    slow = std::max(slow, p->execute.median);
    least = std::min(least, error_of(*p));
    most = std::max(most, error_of(*p));
  }
  const LogAxis x(std::max(fast, 1e-3), std::max(slow, 2e-3), kLeft, kWidth - kRight);
  const LogAxis y(std::min(least, most), most, kHeight - kBottom, kTop);

  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n"
      "<text x=\"{2}\" y=\"18\" font-size=\"14\">{3} {4}×{5}: run time against error</text>\n"
      "<text x=\"{2}\" y=\"34\" fill=\"#666\">{6}</text>\n",
      kWidth, kHeight, kLeft, markup_text(cell.preset), cell.size.width, cell.size.height, markup_text(report.device));
  for (const double tick : x.ticks())
    out += fmt::format(
        "<path d=\"M{0:.1f} {1}V{2}\" stroke=\"#ddd\"/><text x=\"{0:.1f}\" y=\"{3}\" "
        "text-anchor=\"middle\">{4:g}</text>\n",
        x.at(tick), kTop, kHeight - kBottom, kHeight - kBottom + 16, tick);
  for (const double tick : y.ticks())
    out += fmt::format(
        "<path d=\"M{1} {0:.1f}H{2}\" stroke=\"#ddd\"/><text x=\"{3}\" y=\"{4:.1f}\" "
        "text-anchor=\"end\">{5:.0e}</text>\n",
        y.at(tick), kLeft, kWidth - kRight, kLeft - 6, y.at(tick) + 4, tick);
  out += fmt::format(
      "<text x=\"{:.0f}\" y=\"{}\" text-anchor=\"middle\">milliseconds, median of {} (bar: quartiles)</text>\n"
      "<text transform=\"translate(16 {:.0f}) rotate(-90)\" text-anchor=\"middle\">error, 99.99th percentile</text>\n",
      (kLeft + kWidth - kRight) / 2, kHeight - 16, report.repeat, (kTop + kHeight - kBottom) / 2);
  out += fmt::format(
      "<path d=\"M{0:.1f} {1}V{2}\" stroke=\"#999\" stroke-dasharray=\"4 3\"/><text x=\"{3:.1f}\" y=\"{4}\" "
      "fill=\"#666\">one copy pass</text>\n",
      x.at(cell.copy.median), kTop, kHeight - kBottom, x.at(cell.copy.median) + 4, kTop + 12);

  std::string line;
  for (const Point* p : points)
    if (p->front)
      line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", x.at(p->execute.median), y.at(error_of(*p)));
  if (!line.empty()) out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"#c43\" stroke-width=\"2\"/>\n", line);
  int number = 0;
  for (const Point* p : points) {
    const double px = x.at(p->execute.median), py = y.at(error_of(*p)), row = kTop + 18.0 * ++number;
    const char* color = p->front ? "#c43" : "#47a";
    out += fmt::format(
        "<path d=\"M{:.1f} {:.1f}H{:.1f}\" stroke=\"#888\"/><circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"8\" fill=\"{}\"/>"
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" font-size=\"10\" fill=\"#fff\">{}</text>\n",
        x.at(std::max(p->execute.lower, 1e-3)), py, x.at(p->execute.upper), px, py, color, px, py + 3.5, number);
    out +=
        fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" font-size=\"11\" fill=\"{}\">{}  {}: {:.3g} ms, {:.1e}</text>\n",
                    kWidth - kRight + 16, row, color, number,
                    markup_text(p->label + (p->settings.empty() ? "" : " " + p->settings)), p->execute.median,
                    p->quality->error.percentile);
  }
  return out + "</svg>\n";
}

}  // namespace afterglow::bench
