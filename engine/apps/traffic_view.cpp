// SPDX-License-Identifier: MIT
#include "apps/traffic_view.h"

#include <fmt/format.h>

#include <vector>

#include "core/table.h"
#include "core/text.h"
#include "graph/memory.h"

namespace afterglow {
namespace {

/// Ways that move different bytes; the second is what GPUs take where no error is allowed.
const std::vector<ExecutionConfig>& ways_of_traffic() {
  static const std::vector<ExecutionConfig> ways{
      {.fusion = Fusion::none},
      {.compute = true},
      {.storage = Storage::fp16, .compute = true},
      {.fusion = Fusion::filters, .storage = Storage::fp16},
  };
  return ways;
}

Traffic traffic_in(const Graph& graph, const ExecutionConfig& way, const TrafficOptions& options) {
  const Plan plan = make_plan(graph, way);
  if (!options.part) return traffic_of(graph, plan, way);
  const Regions parts = regions(graph, plan, *options.part);
  return traffic_of(graph, plan, way, &parts);
}

}  // namespace

std::string traffic_text(const Graph& graph, const std::string& title, const TrafficOptions& options) {
  const Size size = graph.images[static_cast<std::size_t>(graph.result)].size;
  std::string out = fmt::format("{} at {}×{}: bytes that kernels read and write, each image once a kernel\n", title,
                                size.width, size.height);
  std::vector<std::string> head{"way", "moved", "of it small images", "unavoidable", "the rest in units of that"};
  if (options.bandwidth) head.push_back(fmt::format("ms at {:g} GB/s", *options.bandwidth));
  Table ways(head);
  for (const auto& way : ways_of_traffic()) {
    const Traffic traffic = traffic_in(graph, way, options);
    std::vector<std::string> row{execution_name(way), memory_text(traffic.total), memory_text(traffic.small),
                                 memory_text(traffic.unavoidable), fmt::format("{:.2f}", traffic.excess())};
    if (options.bandwidth) row.push_back(fmt::format("{:.3f}", traffic.milliseconds(*options.bandwidth * 1e9)));
    ways.add(std::move(row));
  }
  out += ways.text("  ");
  const ExecutionConfig& gpu = ways_of_traffic()[1];
  out += fmt::format("kernels of '{}'\n", execution_name(gpu));
  Table kernels({"read", "written", "kernel"});
  for (const auto& kernel : traffic_in(graph, gpu, options).kernels)
    kernels.add({memory_text(kernel.read), memory_text(kernel.written), kernel.name});
  return out + kernels.text("  ");
}

nlohmann::ordered_json traffic_json(const Graph& graph, const TrafficOptions& options) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const auto& way : ways_of_traffic()) {
    const Traffic traffic = traffic_in(graph, way, options);
    nlohmann::ordered_json one{{"way", execution_name(way)},
                               {"bytes", traffic.total},
                               {"bytes_of_small_images", traffic.small},
                               {"unavoidable_bytes", traffic.unavoidable},
                               {"excess", traffic.excess()},
                               {"kernels", nlohmann::ordered_json::array()}};
    if (options.bandwidth) one["milliseconds"] = traffic.milliseconds(*options.bandwidth * 1e9);
    for (const auto& kernel : traffic.kernels)
      one["kernels"].push_back({{"name", kernel.name}, {"read", kernel.read}, {"written", kernel.written}});
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace afterglow
