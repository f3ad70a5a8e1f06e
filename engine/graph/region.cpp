// SPDX-License-Identifier: MIT
#include "graph/region.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "graph/history.h"

namespace afterglow {
namespace {

bool is_empty(const Rect& rect) { return rect.width <= 0 || rect.height <= 0; }

/// Coordinates from `first` to `last`, both included.
struct Span {
  int first = 0, last = -1;
};

/// How far a read goes before and behind the point that corresponds to a target pixel's centre, in texels.
struct Reach {
  double before = 0, behind = 0;
};

/// Texels between which the point ± reach of every pixel of `target` lies, with the texels that `around` reads beside a
/// point (1: linear). One more on each side covers what rounding may do to a position.
Span source_span(Span target, int source_size, int target_size, Reach reach, int around) {
  const double ratio = static_cast<double>(source_size) / target_size;
  const double first = (target.first + 0.5) * ratio - 0.5 - reach.before;
  const double last = (target.last + 0.5) * ratio - 0.5 + reach.behind;
  const auto clamped = [&](double at) {
    return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(source_size - 1)));
  };
  return {clamped(std::floor(first) - around), clamped(std::ceil(last) + around)};
}

Rect source_rect(const Rect& target, Size source_size, Size target_size, Reach x, Reach y, int around) {
  const Span columns =
      source_span({target.x, target.x + target.width - 1}, source_size.width, target_size.width, x, around);
  const Span rows =
      source_span({target.y, target.y + target.height - 1}, source_size.height, target_size.height, y, around);
  return {columns.first, rows.first, columns.last - columns.first + 1, rows.last - rows.first + 1};
}

void extend(Reach& reach, double offset) {
  reach.before = std::max(reach.before, -offset);
  reach.behind = std::max(reach.behind, offset);
}

Rect filter_rect(const Filter& filter, const Rect& target, Size source_size, Size target_size) {
  // Taps on one side alone still keep the point itself: rectangles a little too large are harmless.
  Reach x, y;
  if (filter.separable()) {
    for (const auto& tap : filter.x) extend(x, tap.offset);
    for (const auto& tap : filter.y) extend(y, tap.offset);
  }
  for (const auto& tap : filter.taps) extend(x, tap.dx), extend(y, tap.dy);
  if (filter.edges == Edges::mirror)  // what is mirrored lies on the other side
    for (Reach* axis : {&x, &y}) axis->before = axis->behind = std::max(axis->before, axis->behind);
  const int around = filter.interpolation == Interpolation::cubic_bspline ? 3 : 2;
  return source_rect(target, source_size, target_size, x, y, around);
}

/// Grown to whole blocks, within the image.
Rect in_blocks(const Rect& rect, Size block, Size image) {
  const auto begin = [](int first, int size) { return first / size * size; };
  const auto end = [](int last, int size, int most) { return std::min((last + size - 1) / size * size, most); };
  const int x = begin(rect.x, block.width), y = begin(rect.y, block.height);
  return {x, y, end(rect.x + rect.width, block.width, image.width) - x,
          end(rect.y + rect.height, block.height, image.height) - y};
}

/// What a pass reads of an input when `target` of its output is drawn.
Rect input_rect(const Graph& graph, const Pass& pass, const PassInput& input, const Rect& target) {
  if (input.pixelwise) return target;
  const Size source = graph.images[input.image].size, made = graph.images[pass.output].size;
  if (pass.kind == PassKind::filter) return filter_rect(pass.filter, target, source, made);
  if (!pass.reach) return {0, 0, source.width, source.height};
  const Reach reach{*pass.reach, *pass.reach};
  return source_rect(target, source, made, reach, reach, 1);
}

}  // namespace

Rect united(const Rect& a, const Rect& b) {
  if (is_empty(a)) return b;
  if (is_empty(b)) return a;
  const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

Regions regions(const Graph& graph, const Plan& plan, const Rect& wanted, const std::vector<Size>& blocks) {
  Regions out;
  out.kernels.resize(plan.kernels.size());
  out.images.resize(graph.images.size());
  out.images[graph.result] = wanted;
  // Later frames may read any pixel of what is kept for them, and another region may be wanted then.
  for (const auto& history : graph.histories) {
    const Size size = graph.images[history.next].size;
    out.images[history.next] = {0, 0, size.width, size.height};
  }
  for (std::size_t k = plan.kernels.size(); k-- > 0;) {
    const PlanKernel& kernel = plan.kernels[k];
    if (is_empty(out.images[kernel.output])) continue;
    const Size block = blocks.empty() ? Size{1, 1} : blocks[k];
    const Rect target = out.kernels[k] = in_blocks(out.images[kernel.output], block, graph.images[kernel.output].size);
    for (const int index : kernel.passes) {
      const Pass& pass = graph.passes[index];
      // All passes of a kernel make images of one size, at the same pixels. What flows from one to the next is no
      // image: its entry is set all the same, and no kernel draws it.
      for (const auto& input : pass.inputs) {
        const Rect part = input_rect(graph, pass, input, target);
        out.images[input.image] = united(out.images[input.image], part);
        const History* history = history_of_previous(graph, input.image);
        if (history && history->first != kNoImage)
          out.images[history->first] = united(out.images[history->first], part);
      }
    }
  }
  return out;
}

bool same_reach(const Graph& a, const Graph& b) {
  return std::ranges::equal(a.passes, b.passes, {}, &Pass::reach, &Pass::reach);
}

Skipped skipped_pixels(const Graph& graph, const Plan& plan, const Regions& regions) {
  double drawn = 0, all = 0;
  for (std::size_t k = 0; k < plan.kernels.size(); ++k) {
    drawn += static_cast<double>(regions.kernels[k].size().area());
    all += static_cast<double>(graph.images[plan.kernels[k].output].size.area());
  }
  return {fmt::format("{:.1f} % of the pixels", all > 0 ? 100 * (1 - drawn / all) : 0.0),
          "the region does not need them"};
}

}  // namespace afterglow
