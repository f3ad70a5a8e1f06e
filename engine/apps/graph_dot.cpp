// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/graph_view.h"
#include "core/json_text.h"
#include "core/printable.h"
#include "graph/condition.h"
#include "graph/history.h"

namespace afterglow {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : printable(text)) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

/// Node that makes an image.
std::string node(const Graph& graph, ImageId image) {
  const auto& made = graph.images[static_cast<std::size_t>(image)];
  return made.producer < 0 ? fmt::format("image{}", image) : fmt::format("pass{}", made.producer);
}

std::string pass_line(const Graph& graph, int index) {
  const Pass& pass = graph.passes[static_cast<std::size_t>(index)];
  std::string label = fmt::format("{}\n{} {}", printable(pass.name), info_of(pass.kind).name, size_text(graph, pass));
  std::string escaped;
  for (const char c : label)
    escaped += c == '\n' ? std::string("\\n") : c == '"' ? std::string("\\\"") : std::string(1, c);
  return fmt::format("pass{} [label=\"{}\"];\n", index, escaped);
}

}  // namespace

std::vector<Skipped> all_skipped(const Graph& graph, const Plan& plan) {
  std::vector<Skipped> all = graph.skipped;
  all.insert(all.end(), plan.skipped.begin(), plan.skipped.end());
  return all;
}

std::vector<std::string> idle_lines(const Graph& graph) {
  std::vector<std::string> out;
  for (const auto& condition : graph.idle)
    if (condition.image == graph.source)
      out.push_back(fmt::format("{}, when {}", condition.effect, idle_reason(condition)));
  return out;
}

int kernel_of(const Plan& plan, int pass) {
  for (std::size_t i = 0; i < plan.kernels.size(); ++i)
    if (std::ranges::find(plan.kernels[i].passes, pass) != plan.kernels[i].passes.end()) return static_cast<int>(i);
  return -1;
}

std::string size_text(const Graph& graph, const Pass& pass) {
  const GraphImage& image = graph.images[static_cast<std::size_t>(pass.output)];
  const char* channels = image.channels == 1 ? ", 1 channel" : image.channels == 2 ? ", 2 channels" : "";
  return fmt::format("{}×{}{}", image.size.width, image.size.height, channels);
}

std::string graph_dot(const Graph& graph, const Plan& plan, const std::string& title, const Notes& notes) {
  std::string out = fmt::format(
      "digraph {} {{\n  rankdir=TB;\n  node [shape=box, style=rounded, fontname=\"sans-serif\"];\n", quoted(title));
  for (std::size_t i = 0; i < graph.images.size(); ++i)
    if (graph.images[i].producer < 0)
      out += fmt::format("  image{} [label={}, shape=ellipse];\n", i,
                         quoted(graph.images[i].name +
                                (history_of_previous(graph, static_cast<ImageId>(i)) ? "\nof the frame before" : "")));
  for (std::size_t k = 0; k < plan.kernels.size(); ++k) {
    const auto& kernel = plan.kernels[k];
    const bool fused = kernel.passes.size() > 1;
    if (fused)
      out += fmt::format("  subgraph cluster{} {{\n    label={};\n    tooltip={};\n", k,
                         quoted(fmt::format("kernel {}", k)), quoted(kFusionReason));
    for (const int pass : kernel.passes) out += (fused ? "    " : "  ") + pass_line(graph, pass);
    if (fused) out += "  }\n";
  }
  for (std::size_t p = 0; p < graph.passes.size(); ++p) {
    if (kernel_of(plan, static_cast<int>(p)) < 0) continue;
    for (const auto& input : graph.passes[p].inputs)
      out += fmt::format("  {} -> pass{} [label={}];\n", node(graph, input.image), p,
                         quoted(input.name == "source" ? "" : input.name));
  }
  for (const auto& history : graph.histories) {
    out += fmt::format("  {} -> image{} [style=dashed, label=\"next frame\", constraint=false];\n",
                       node(graph, history.next), history.previous);
    if (history.first != kNoImage)
      out += fmt::format("  {} -> image{} [style=dotted, label=\"first frame\"];\n", node(graph, history.first),
                         history.previous);
  }
  out += fmt::format("  result [shape=ellipse];\n  {} -> result;\n", node(graph, graph.result));
  for (std::size_t i = 0; i < notes.size(); ++i)
    out += fmt::format("  note{} [label={}, shape=note, style=\"\"];\n", i,
                       quoted(fmt::format("{}: {}", notes[i].first, notes[i].second)));
  const auto skipped = all_skipped(graph, plan);
  for (std::size_t i = 0; i < skipped.size(); ++i)
    out += fmt::format("  skipped{} [label={}, style=\"rounded,dashed\", fontcolor=gray40, color=gray60];\n", i,
                       quoted(fmt::format("{}: {}", skipped[i].name, skipped[i].reason)));
  const auto idle = idle_lines(graph);
  for (std::size_t i = 0; i < idle.size(); ++i)
    out += fmt::format("  idle{} [label={}, style=\"rounded,dotted\", fontcolor=gray40, color=gray60];\n", i,
                       quoted("not run: " + idle[i]));
  return out + "}\n";
}

std::string graph_json(const Graph& graph, const Plan& plan, const std::string& title, const Notes& notes) {
  using Json = nlohmann::ordered_json;
  Json out{{"preset", title},
           {"graph", Json::parse(to_json(graph))},
           {"kernels", Json::array()},
           {"skipped", Json::array()}};
  for (std::size_t k = 0; k < plan.kernels.size(); ++k) {
    const PlanKernel& kernel = plan.kernels[k];
    Json item{{"name", kernel.name}, {"passes", Json::array()}};
    for (const int pass : kernel.passes) item["passes"].push_back(graph.passes[static_cast<std::size_t>(pass)].name);
    if (plan.once[k]) item["once"] = true;
    if (kernel.passes.size() > 1) item["fused_because"] = std::string("the later passes ") + kFusionReason;
    out["kernels"].push_back(std::move(item));
  }
  for (const auto& [entry, text] : notes) out["composition"][entry] = text;
  for (const auto& skipped : all_skipped(graph, plan))
    out["skipped"].push_back(Json{{"name", skipped.name}, {"reason", skipped.reason}});
  return json_text(out);
}

}  // namespace afterglow
