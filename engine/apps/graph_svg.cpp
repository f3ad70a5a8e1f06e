// SPDX-License-Identifier: MIT
// A drawing by levels made here, so that `--format svg` needs no graphviz: images of one size stand side by side in the
// order in which they are made, smaller ones below, so that a pyramid looks like one. Long rows are wrapped.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "apps/graph_view.h"
#include "core/text.h"
#include "graph/history.h"

namespace afterglow {
namespace {

constexpr double kBoxWidth = 250, kBoxHeight = 44, kGapX = 30, kGapY = 46, kMargin = 24, kTitle = 40, kLine = 18;
constexpr std::size_t kMostColumns = 8;

struct Node {
  std::string label, detail, color;
  std::vector<std::size_t> inputs;
  Size size;
  bool rounded = false;
  std::size_t row = 0, column = 0;
  double x = 0, y = 0;
};

/// Kernels of several passes share a tint; the others are white.
std::string tint(const Plan& plan, int kernel) {
  static constexpr const char* kTints[] = {"#e3f0ff", "#fdebd7", "#e5f6e3", "#f6e3f3", "#fff6cf", "#e2f4f4"};
  return plan.kernels[static_cast<std::size_t>(kernel)].passes.size() > 1 ? kTints[static_cast<std::size_t>(kernel) % 6]
                                                                          : "#ffffff";
}

/// Inputs, then the passes that run, then the result, in an order in which inputs come first.
std::vector<Node> nodes_of(const Graph& graph, const Plan& plan) {
  std::vector<Node> nodes;
  std::vector<std::size_t> of_image(graph.images.size(), 0);
  for (std::size_t i = 0; i < graph.images.size(); ++i) {
    if (graph.images[i].producer >= 0) continue;
    of_image[i] = nodes.size();
    const Size size = graph.images[i].size;
    nodes.push_back(
        {graph.images[i].name,
         fmt::format("{} {}×{}", history_of_previous(graph, static_cast<ImageId>(i)) ? "frame before," : "input",
                     size.width, size.height),
         "#eeeeee",
         {},
         size,
         true});
  }
  for (std::size_t p = 0; p < graph.passes.size(); ++p) {
    const Pass& pass = graph.passes[p];
    const int kernel = kernel_of(plan, static_cast<int>(p));
    if (kernel < 0) continue;
    Node node{pass.name,
              fmt::format("{} {}, kernel {}", info_of(pass.kind).name, size_text(graph, pass), kernel),
              tint(plan, kernel),
              {},
              graph.images[static_cast<std::size_t>(pass.output)].size};
    for (const auto& input : pass.inputs) node.inputs.push_back(of_image[static_cast<std::size_t>(input.image)]);
    of_image[static_cast<std::size_t>(pass.output)] = nodes.size();
    nodes.push_back(std::move(node));
  }
  nodes.push_back({"result",
                   "",
                   "#eeeeee",
                   {of_image[static_cast<std::size_t>(graph.result)]},
                   graph.images[graph.result].size,
                   true});
  return nodes;
}

/// Returns the width of the widest row.
double lay_out(std::vector<Node>& nodes) {
  const auto level = [](const Node& node) {
    return std::pair(-node.size.area(), -node.size.width);
  };  // large ones first
  std::map<std::pair<long long, int>, std::size_t> count;
  for (const auto& node : nodes) ++count[level(node)];
  std::map<std::pair<long long, int>, std::size_t> first_row, placed;
  std::size_t rows = 0, columns = 0;
  for (const auto& [of, number] : count) {
    first_row[of] = rows;
    rows += (number + kMostColumns - 1) / kMostColumns;
    columns = std::max(columns, std::min(number, kMostColumns));
  }
  for (auto& node : nodes) {
    const std::size_t place = placed[level(node)]++;
    node.row = first_row[level(node)] + place / kMostColumns;
    node.column = place % kMostColumns;
    node.x = kMargin + static_cast<double>(node.column) * (kBoxWidth + kGapX);
    node.y = kTitle + kMargin + static_cast<double>(node.row) * (kBoxHeight + kGapY);
  }
  return static_cast<double>(columns) * (kBoxWidth + kGapX) - kGapX;
}

std::string curve(double x0, double y0, double x1, double y1, double bend_x, double bend_y) {
  return fmt::format(
      "<path d=\"M{:.0f} {:.0f} C{:.0f} {:.0f} {:.0f} {:.0f} {:.0f} {:.0f}\" marker-end=\"url(#arrow)\"/>\n", x0, y0,
      x0 + bend_x, y0 + bend_y, x1 - bend_x, y1 + (bend_x == 0 ? -bend_y : bend_y), x1, y1);
}

std::string edge(const Node& from, const Node& to) {
  const double middle_from = from.x + kBoxWidth / 2, middle_to = to.x + kBoxWidth / 2;
  if (from.row == to.row && to.column == from.column + 1)
    return curve(from.x + kBoxWidth, from.y + kBoxHeight / 2, to.x, to.y + kBoxHeight / 2, kGapX / 2, 0);
  if (from.row == to.row) {  // over the boxes between
    const double up = -0.6 * kGapY;
    return fmt::format(
        "<path d=\"M{:.0f} {:.0f} C{:.0f} {:.0f} {:.0f} {:.0f} {:.0f} {:.0f}\" marker-end=\"url(#arrow)\"/>\n",
        middle_from, from.y, middle_from, from.y + up, middle_to, to.y + up, middle_to, to.y);
  }
  const bool down = from.row < to.row;
  const double y0 = down ? from.y + kBoxHeight : from.y, y1 = down ? to.y : to.y + kBoxHeight;
  return curve(middle_from, y0, middle_to, y1, 0, (y1 - y0) / 2);
}

std::string box(const Node& node) {
  std::string out =
      fmt::format("<rect x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\" rx=\"{}\" fill=\"{}\"/>\n",
                  node.x, node.y, kBoxWidth, kBoxHeight, node.rounded ? 22 : 6, node.color);
  const double middle = node.x + kBoxWidth / 2;
  out += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\">{}</text>\n", middle, node.y + (node.detail.empty() ? 27 : 19),
                     markup_text(node.label));
  if (!node.detail.empty())
    out += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" class=\"detail\">{}</text>\n", middle, node.y + 35,
                       markup_text(node.detail));
  return out;
}

}  // namespace

std::string graph_svg(const Graph& graph, const Plan& plan, const std::string& title, const Notes& notes) {
  auto nodes = nodes_of(graph, plan);
  double width = lay_out(nodes) + 2 * kMargin;
  const auto skipped = all_skipped(graph, plan);
  std::vector<std::string> lines;
  if (std::ranges::any_of(plan.kernels, [](const auto& k) { return k.passes.size() > 1; }))
    lines.push_back(std::string("Passes of one tint are fused into one kernel: the later ones ") + kFusionReason + ".");
  for (const auto& [entry, text] : notes) lines.push_back(fmt::format("{}: {}", entry, text));
  for (const auto& entry : skipped) lines.push_back(fmt::format("Skipped {}: {}", entry.name, entry.reason));
  for (const auto& line : idle_lines(graph)) lines.push_back("Not run: " + line);
  for (const auto& line : lines) width = std::max(width, 2 * kMargin + 7.5 * static_cast<double>(line.size()));
  double bottom = 0;
  for (const auto& node : nodes) bottom = std::max(bottom, node.y + kBoxHeight);
  const double height = bottom + kMargin + kLine * static_cast<double>(lines.size()) + kMargin;

  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\">\n"
      "<style>text{{font:13px sans-serif;text-anchor:middle}}.detail{{font-size:11px;fill:#555}}"
      ".note{{text-anchor:start}}rect{{stroke:#444}}path{{stroke:#666;fill:none}}</style>\n"
      "<defs><marker id=\"arrow\" viewBox=\"0 0 8 8\" refX=\"8\" refY=\"4\" markerWidth=\"8\" markerHeight=\"8\" "
      "orient=\"auto\">"
      "<path d=\"M0 0 L8 4 L0 8 z\" style=\"fill:#666;stroke:none\"/></marker></defs>\n"
      "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" style=\"fill:#fff;stroke:none\"/>\n",
      width, height);
  out += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" class=\"note\" style=\"font-size:17px\">{}</text>\n", kMargin,
                     kTitle, markup_text(title));
  for (const auto& node : nodes)
    for (const auto input : node.inputs) out += edge(nodes[input], node);
  for (const auto& node : nodes) out += box(node);
  double y = bottom + kMargin + kLine;
  for (const auto& line : lines) {
    out += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" class=\"note\">{}</text>\n", kMargin, y, markup_text(line));
    y += kLine;
  }
  return out + "</svg>\n";
}

}  // namespace afterglow
