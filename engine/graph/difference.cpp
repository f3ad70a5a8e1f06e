// SPDX-License-Identifier: MIT
#include "graph/difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/text.h"

namespace afterglow {
namespace {

std::string value_text(const ParamValue& value) {
  const auto in_braces = [](const std::vector<std::string>& texts) {
    return texts.size() == 1 ? texts.front() : "{ " + join(texts) + " }";
  };
  std::vector<std::string> rows;
  for (const auto& row : rows_of(value)) {
    std::vector<std::string> numbers;
    for (const double number : row) numbers.push_back(number_text(number));
    rows.push_back(in_braces(numbers));
  }
  return in_braces(rows);
}

std::string image_name(const Graph& graph, ImageId id) {
  return id == kNoImage ? std::string() : graph.images[static_cast<std::size_t>(id)].name;
}

Hash data_hash(const Graph& graph, ImageId id) {
  const auto& data = graph.images[static_cast<std::size_t>(id)].data;
  return data ? data->hash : Hash{};
}

/// Images have other ids where an entry before makes more of them; their names stay, and the pixels that they came
/// with.
bool same_inputs(const Graph& a, const Pass& p, const Graph& b, const Pass& q) {
  return std::ranges::equal(p.inputs, q.inputs, [&](const PassInput& x, const PassInput& y) {
    return x.name == y.name && x.pixelwise == y.pixelwise && image_name(a, x.image) == image_name(b, y.image) &&
           data_hash(a, x.image) == data_hash(b, y.image);
  });
}

bool same_target(const Graph& a, const Pass& p, const Graph& b, const Pass& q) {
  const GraphImage &x = a.images[static_cast<std::size_t>(p.output)], &y = b.images[static_cast<std::size_t>(q.output)];
  return x.size == y.size && x.channels == y.channels && x.precise == y.precise;
}

std::string pass_difference(const Graph& a, const Pass& p, const Graph& b, const Pass& q) {
  for (const auto& [name, value] : p.params)
    if (const auto other = q.params.find(name); other != q.params.end() && !(other->second == value))
      return fmt::format("{} of pass '{}' is {}, then {}", name, p.name, value_text(value), value_text(other->second));
  const bool same = p.name == q.name && p.kind == q.kind && p.shader == q.shader &&
                    p.by_workgroups == q.by_workgroups && p.filter == q.filter && same_inputs(a, p, b, q) &&
                    p.params == q.params && p.constants == q.constants && p.reach == q.reach &&
                    p.straight == q.straight && p.lights_black == q.lights_black && same_target(a, p, b, q);
  return same ? std::string() : fmt::format("pass '{}' is made otherwise", p.name);
}

template <class Item>
std::vector<const Item*> of_effect(const std::vector<Item>& items, const std::string& effect) {
  std::vector<const Item*> out;
  for (const Item& item : items)
    if (item.effect == effect) out.push_back(&item);
  return out;
}

std::string passes_difference(const Graph& a, const Graph& b, const std::string& effect) {
  const auto ours = of_effect(a.passes, effect), theirs = of_effect(b.passes, effect);
  if (ours.size() != theirs.size())
    return fmt::format("the number of its passes is {}, then {}", ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i)
    if (auto what = pass_difference(a, *ours[i], b, *theirs[i]); !what.empty()) return what;
  return {};
}

bool same_histories(const Graph& a, const Graph& b, const std::string& effect) {
  return std::ranges::equal(of_effect(a.histories, effect), of_effect(b.histories, effect),
                            [&](const History* x, const History* y) {
                              return x->name == y->name && image_name(a, x->next) == image_name(b, y->next) &&
                                     image_name(a, x->first) == image_name(b, y->first) && x->initial == y->initial &&
                                     x->precise == y->precise && x->pre_roll == y->pre_roll;
                            });
}

bool same_idle(const Graph& a, const Graph& b, const std::string& effect) {
  return std::ranges::equal(of_effect(a.idle, effect), of_effect(b.idle, effect),
                            [](const IdleCondition* x, const IdleCondition* y) { return x->limit == y->limit; });
}

/// Entries that make something, in their order.
std::vector<std::string> effects_of(const Graph& a, const Graph& b) {
  std::vector<std::string> out;
  for (const Graph* graph : {&a, &b})
    for (const Pass& pass : graph->passes)
      if (std::ranges::find(out, pass.effect) == out.end()) out.push_back(pass.effect);
  return out;
}

}  // namespace

std::optional<Difference> first_difference(const Graph& a, const Graph& b) {
  for (const std::string& effect : effects_of(a, b)) {
    if (auto what = passes_difference(a, b, effect); !what.empty()) return Difference{effect, std::move(what)};
    if (!same_histories(a, b, effect)) return Difference{effect, "its histories are others"};
    if (!same_idle(a, b, effect)) return Difference{effect, "idle gives another limit"};
  }
  for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (const Skipped& skipped : one->skipped)
      if (std::ranges::find(other->skipped, skipped) == other->skipped.end())
        return Difference{skipped.name, "it is not left out each time for the same reason"};
  if (image_name(a, a.result) == image_name(b, b.result)) return {};
  const Graph& made = a.result == a.source ? b : a;
  const int producer = made.images[static_cast<std::size_t>(made.result)].producer;
  return Difference{producer < 0 ? "" : made.passes[static_cast<std::size_t>(producer)].effect,
                    "it returns another image"};
}

}  // namespace afterglow
